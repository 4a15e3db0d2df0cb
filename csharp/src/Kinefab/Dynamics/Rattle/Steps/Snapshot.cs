using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>All of a batch that an attempt at a step changes.</summary>
internal sealed class Snapshot
{
    private readonly double[] _bodies;
    private readonly double[] _half;
    private readonly double[] _total;
    private readonly WarmStart[] _scalars;

    // LastTwist of each block's joint, or both coordinates of its coupling.
    private readonly double[] _angles;

    public Snapshot(LaneBatch<ScalarLane> batch)
    {
        _bodies = new double[batch.Bodies.Length];
        _half = new double[batch.VelocityImpulses.Length];
        _total = new double[batch.VelocityImpulses.Length];
        _scalars = new WarmStart[batch.Shape.ScalarCount];
        _angles = new double[2 * batch.Shape.Blocks.Length];
    }

    public void Save(LaneBatch<ScalarLane> batch)
    {
        Array.Copy(batch.Bodies, _bodies, _bodies.Length);
        Array.Copy(batch.VelocityImpulses, _half, _half.Length);
        Array.Copy(batch.Work.TotalImpulses, _total, _total.Length);
        batch.Scalars?.Save(_scalars);
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            RowBlock block = batch.Shape.Blocks[n];
            _angles[2 * n] = block.Coupling?.LastA ?? block.Joint!.LastTwist;
            _angles[2 * n + 1] = block.Coupling?.LastB ?? 0;
        }
    }

    public void Restore(LaneBatch<ScalarLane> batch)
    {
        Array.Copy(_bodies, batch.Bodies, _bodies.Length);
        Array.Copy(_half, batch.VelocityImpulses, _half.Length);
        Array.Copy(_total, batch.Work.TotalImpulses, _total.Length);
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            RowBlock block = batch.Shape.Blocks[n];
            if (block.Coupling != null)
            {
                block.Coupling.LastA = _angles[2 * n];
                block.Coupling.LastB = _angles[2 * n + 1];
            }
            else
            {
                block.Joint!.LastTwist = _angles[2 * n];
            }
        }

        RattleStep<ScalarLane>.Rebuild(batch);
        batch.Scalars?.Restore(_scalars);
    }
}
