using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>The turn of a hinge about the X of its frames, in lanes.</summary>
internal static class HingeTurn<V>
    where V : struct, ILane<V>
{
    /// <summary>Cosine and sine of the turn of frame 1 against frame 0 where the frames were last placed: y1 along y0 and z0.</summary>
    /// <param name="batch">The records.</param>
    /// <param name="n">The hinge's block.</param>
    /// <param name="to">Takes them, one after the other.</param>
    /// <param name="at">Where.</param>
    [MethodImpl(MethodImplOptions.NoInlining)]
    public static void Measure(LaneRecords<V> batch, int n, double[] to, int at)
    {
        int body = batch.Shape.Blocks[n].Bodies[1];
        int frame0 = LaneRecords<V>.Joint(n, LaneRecords<V>.WorldFrame(0));
        LaneVector<V> y1 = LaneVector<V>.Load(batch.Joints, LaneRecords<V>.Joint(n, LaneRecords<V>.Frame(1)), 6);
        if (!batch.Shape.IsStatic[body])
        {
            int r = LaneRecords<V>.Body(body, BodyLanes.R);
            y1 = new LaneVector<V>(
                LaneVector<V>.Dot(LaneVector<V>.Load(batch.Bodies, r), y1),
                LaneVector<V>.Dot(LaneVector<V>.Load(batch.Bodies, r, 3), y1),
                LaneVector<V>.Dot(LaneVector<V>.Load(batch.Bodies, r, 6), y1));
        }

        LaneVector<V>.Dot(LaneVector<V>.Load(batch.Joints, frame0, 6), y1).Store(to, at);
        LaneVector<V>.Dot(LaneVector<V>.Load(batch.Joints, frame0, 9), y1).Store(to, at, 1);
    }

    /// <summary>The axis where the frames were last placed: X of frame 1, which is frame 0's to the tolerance.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneVector<V> Axis(LaneRecords<V> batch, int n) =>
        LaneVector<V>.Load(batch.Joints, LaneRecords<V>.Joint(n, LaneRecords<V>.WorldFrame(1)), 3);
}
