using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>Islands of one shape, stepped side by side.</summary>
internal abstract class IslandGroup
{
    public abstract void Step(double dt);
}

/// <inheritdoc/>
internal sealed class IslandGroup<V> : IslandGroup
    where V : struct, ILane<V>
{
    public static long Its, Calls, Fails;
    private readonly Mechanism _mechanism;
    private readonly Island[] _islands;
    private readonly Batch<V>[] _batches;
    private readonly bool[] _converged = new bool[Lane<V>.Width];
    private readonly double _tolerance;

    public IslandGroup(Mechanism mechanism, List<Island> islands, double tolerance)
    {
        _mechanism = mechanism;
        _islands = islands.ToArray();
        _tolerance = tolerance;
        int width = Lane<V>.Width;
        _batches = new Batch<V>[(_islands.Length + width - 1) / width];
        for (int i = 0; i < _batches.Length; i++)
        {
            var batch = new Batch<V>(_islands[i * width]);
            for (int lane = 0; lane < width; lane++)
            {
                Transfer<V>.LoadConstants(batch, lane, Occupant(i, lane), mechanism);
            }

            _batches[i] = batch;
        }
    }

    /// <inheritdoc/>
    public override void Step(double dt)
    {
        int width = Lane<V>.Width;
        for (int i = 0; i < _batches.Length; i++)
        {
            Batch<V> batch = _batches[i];
            bool isMoved = false;
            for (int lane = 0; lane < width; lane++)
            {
                isMoved |= Transfer<V>.Load(batch, lane, Occupant(i, lane), _mechanism, dt);
            }

            if (isMoved)
            {
                Rebuild(batch);
            }

            Fill(batch, 1);
            Its += RattleStep<V>.Fly(batch, dt, _tolerance, _converged); Calls++; for (int q = 0; q < width; q++) Fails += _converged[q] ? 0 : 1;
            RattleStep<V>.Build(batch);
            Fill(batch, 1);
            RattleStep<V>.Project(batch, dt);
            for (int lane = 0; lane < width && i * width + lane < _islands.Length; lane++)
            {
                Transfer<V>.Store(batch, lane, _islands[i * width + lane], _mechanism);
            }
        }
    }

    private static void Fill(Batch<V> batch, double value)
    {
        for (int lane = 0; lane < batch.Active.Length; lane++)
        {
            batch.Active[lane] = value;
        }
    }

    private static void Rebuild(Batch<V> batch)
    {
        int width = Lane<V>.Width;
        for (int body = 0; body < batch.Shape.Bodies.Length; body++)
        {
            System.Array.Copy(batch.Bodies, Batch<V>.Body(body, BodySlot.X), batch.Bodies, Batch<V>.Body(body, BodySlot.EndX), 3 * width);
            System.Array.Copy(batch.Bodies, Batch<V>.Body(body, BodySlot.Q), batch.Bodies, Batch<V>.Body(body, BodySlot.EndQ), 4 * width);
        }

        LaneMatrices(batch);
        RattleStep<V>.Build(batch);
    }

    private static void LaneMatrices(Batch<V> batch)
    {
        for (int body = 0; body < batch.Shape.Bodies.Length; body++)
        {
            LaneQuaternion<V>.Load(batch.Bodies, Batch<V>.Body(body, BodySlot.EndQ))
                .StoreMatrix(batch.Bodies, Batch<V>.Body(body, BodySlot.R));
        }
    }

    // Lanes without an island of their own work on a copy of the batch's first.
    private Island Occupant(int batch, int lane)
    {
        int index = batch * Lane<V>.Width + lane;
        return _islands[index < _islands.Length ? index : batch * Lane<V>.Width];
    }
}
