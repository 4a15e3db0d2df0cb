using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>All of a batch that an attempt at a step changes.</summary>
internal sealed class Snapshot
{
    private readonly double[] _bodies;
    private readonly double[] _half;
    private readonly double[] _total;
    private readonly WarmStart[] _scalars;

    // LastTwist of each block's joint, or all coordinates of its coupling.
    private readonly double[] _angles;
    private double _compliantWork;
    private double _drivenWork;

    public Snapshot(LaneBatch<ScalarLane> batch)
    {
        _bodies = new double[batch.Bodies.Length];
        _half = new double[batch.VelocityImpulses.Length];
        _total = new double[batch.VelocityImpulses.Length];
        _scalars = new WarmStart[batch.Shape.ScalarCount];
        int angles = 0;
        foreach (RowBlock block in batch.Shape.Blocks)
        {
            angles += block.Coupling?.Last.Length ?? 1;
        }

        _angles = new double[angles];
    }

    public void Save(LaneBatch<ScalarLane> batch)
    {
        _compliantWork = batch.Work.CompliantWork[0];
        _drivenWork = batch.Work.DrivenWork;
        Array.Copy(batch.Bodies, _bodies, _bodies.Length);
        Array.Copy(batch.VelocityImpulses, _half, _half.Length);
        Array.Copy(batch.Work.TotalImpulses, _total, _total.Length);
        batch.Scalars?.Save(_scalars);
        int at = 0;
        for (int n = 0; n < batch.Models.Length; n++)
        {
            CoordinateCoupling? coupling = batch.Couplings[n];
            if (coupling != null)
            {
                coupling.Last.CopyTo(_angles, at);
                at += coupling.Last.Length;
            }
            else
            {
                _angles[at++] = batch.Models[n]!.LastTwist;
            }
        }
    }

    public void Restore(LaneBatch<ScalarLane> batch)
    {
        batch.Work.CompliantWork[0] = _compliantWork;
        batch.Work.DrivenWork = _drivenWork;
        Array.Copy(_bodies, batch.Bodies, _bodies.Length);
        Array.Copy(_half, batch.VelocityImpulses, _half.Length);
        Array.Copy(_total, batch.Work.TotalImpulses, _total.Length);
        int at = 0;
        for (int n = 0; n < batch.Models.Length; n++)
        {
            CoordinateCoupling? coupling = batch.Couplings[n];
            if (coupling != null)
            {
                Array.Copy(_angles, at, coupling.Last, 0, coupling.Last.Length);
                at += coupling.Last.Length;
            }
            else
            {
                batch.Models[n]!.LastTwist = _angles[at++];
            }
        }

        RattleStep<ScalarLane>.Rebuild(batch);
        batch.Scalars?.Restore(_scalars);
    }
}
