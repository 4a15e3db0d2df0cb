using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>All of a batch that an attempt at a step changes.</summary>
internal sealed class Snapshot
{
    private readonly double[] _bodies;
    private readonly double[] _half;
    private readonly double[] _total;
    private readonly WarmStart[] _laws;

    public Snapshot(LaneBatch<ScalarLane> batch)
    {
        _bodies = new double[batch.Bodies.Length];
        _half = new double[batch.VelocityImpulses.Length];
        _total = new double[batch.VelocityImpulses.Length];
        _laws = new WarmStart[batch.Shape.ScalarCount];
    }

    public void Save(LaneBatch<ScalarLane> batch)
    {
        Array.Copy(batch.Bodies, _bodies, _bodies.Length);
        Array.Copy(batch.VelocityImpulses, _half, _half.Length);
        Array.Copy(batch.Work.TotalImpulses, _total, _total.Length);
        batch.Scalars?.Save(_laws);
    }

    public void Restore(LaneBatch<ScalarLane> batch)
    {
        Array.Copy(_bodies, batch.Bodies, _bodies.Length);
        Array.Copy(_half, batch.VelocityImpulses, _half.Length);
        Array.Copy(_total, batch.Work.TotalImpulses, _total.Length);
        RattleStep<ScalarLane>.Rebuild(batch);
        batch.Scalars?.Restore(_laws);
    }
}
