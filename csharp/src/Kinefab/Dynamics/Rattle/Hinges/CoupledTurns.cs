using System.Runtime.CompilerServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Couplings of hinges in lanes, C = sum of g_i turn_i - offset, with g a coordinate's factor times its sign; what <see cref="CoordinateCoupling"/>
/// says of one island for several. The row of a turn's rate is -g (0, x; 0, -x).
/// </summary>
internal static class CoupledTurns<V>
    where V : struct, ILane<V>
{
    private const int Count = LaneRecords<V>.TurnCount;

    // In the record of a coordinate, after its g.
    private const int Last = 1;
    private const int Now = 2;
    private const int Cosine = 3;
    private const int Sine = 4;

    /// <summary>What the coordinates of a lane are, and where they stood after the last step.</summary>
    public static void Gather(LaneRecords<V> batch)
    {
        int w = Lane<V>.Width;
        double[] turns = batch.Turns;
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            RowBlock block = batch.Shape.Blocks[n];
            int o = batch.TurnOffsets[n];
            for (int lane = 0; lane < w && block.Coupled.Length > 0; lane++)
            {
                CoordinateCoupling coupling = batch.Couplings[n * w + lane]!;
                turns[o + lane] = coupling.Offset;
                for (int i = 0; i < block.Coupled.Length; i++)
                {
                    double sign = coupling.Coordinates[i].Sign;
                    int at = o + (1 + i * Count) * w + lane;
                    turns[at] = sign * coupling.Factors[i];
                    turns[at + Last * w] = sign * coupling.Last[i];
                }
            }
        }
    }

    /// <summary>C at the end of the drift.</summary>
    public static void Evaluate(LaneRecords<V> batch, int n)
    {
        int w = Lane<V>.Width;
        double[] turns = batch.Turns;
        int o = batch.TurnOffsets[n];
        Lane<V> sum = Lane<V>.Splat(0);
        foreach (int hinge in batch.Shape.Blocks[n].Coupled)
        {
            int at = o + w;
            HingeTurn<V>.Measure(batch, hinge, turns, at + Cosine * w);
            LaneTrigonometry<V>.Atan2(turns, at + Sine * w, turns, at + Cosine * w, turns, at + Now * w);
            Lane<V> turn = LaneTrigonometry<V>.Nearest(Lane<V>.Load(turns, at + Now * w), Lane<V>.Load(turns, at + Last * w));
            turn.Store(turns, at + Now * w);
            sum += Lane<V>.Load(turns, at) * turn;
            o += Count * w;
        }

        (sum - Lane<V>.Load(turns, batch.TurnOffsets[n])).Store(batch.Work.Error, batch.Shape.Pattern.Rows[n] * w);
    }

    /// <summary>J where the frames were last placed, added up on the bodies that several hinges touch.</summary>
    public static void Build(LaneRecords<V> batch, int n)
    {
        int w = Lane<V>.Width;
        RowBlock block = batch.Shape.Blocks[n];
        int first = batch.Row(n, 0, 0);
        System.Array.Clear(batch.Angular, first, 3 * block.Bodies.Length * w);
        int at = batch.TurnOffsets[n] + w;
        for (int i = 0; i < block.Coupled.Length; i++, at += Count * w)
        {
            Add(batch, block.Coupled[i], at, first + 3 * block.CouplingSides[2 * i] * w, first + 3 * block.CouplingSides[2 * i + 1] * w);
        }
    }

    /// <summary>Notes the turns that a lane has reached by the step.</summary>
    public static void Finish(LaneRecords<V> batch, int lane)
    {
        int w = Lane<V>.Width;
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            int at = batch.TurnOffsets[n] + w + lane;
            for (int i = 0; i < batch.Shape.Blocks[n].Coupled.Length; i++, at += Count * w)
            {
                CoordinateCoupling coupling = batch.Couplings[n * w + lane]!;
                coupling.Last[i] = coupling.Coordinates[i].Sign * batch.Turns[at + Now * w];
            }
        }
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void Add(LaneRecords<V> batch, int hinge, int factor, int to0, int to1)
    {
        LaneVector<V> turn = Lane<V>.Load(batch.Turns, factor) * HingeTurn<V>.Axis(batch, hinge);
        (LaneVector<V>.Load(batch.Angular, to0) - turn).Store(batch.Angular, to0);
        (LaneVector<V>.Load(batch.Angular, to1) + turn).Store(batch.Angular, to1);
    }
}
