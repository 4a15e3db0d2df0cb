using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>All of a batch that an attempt at a step changes.</summary>
internal sealed class Snapshot
{
    private readonly double[] _bodies;
    private readonly double[] _half;
    private readonly double[] _total;
    private readonly LawHistory[] _laws;

    public Snapshot(Batch<ScalarLane> batch)
    {
        _bodies = new double[batch.Bodies.Length];
        _half = new double[batch.Half.Length];
        _total = new double[batch.Half.Length];
        _laws = new LawHistory[batch.Shape.Laws];
    }

    public void Save(Batch<ScalarLane> batch)
    {
        Array.Copy(batch.Bodies, _bodies, _bodies.Length);
        Array.Copy(batch.Half, _half, _half.Length);
        Array.Copy(batch.Work.Total, _total, _total.Length);
        batch.Laws?.Save(_laws);
    }

    public void Restore(Batch<ScalarLane> batch)
    {
        Array.Copy(_bodies, batch.Bodies, _bodies.Length);
        Array.Copy(_half, batch.Half, _half.Length);
        Array.Copy(_total, batch.Work.Total, _total.Length);
        RattleStep<ScalarLane>.Rebuild(batch);
        batch.Laws?.Restore(_laws);
    }
}
