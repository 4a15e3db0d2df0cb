using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>Energy of an island on the only lane, J.</summary>
internal readonly struct Energy
{
    // Rounding of the forces' work, against its terms.
    private const double Rounding = 1e-12;

    private readonly double _kinetic;
    private readonly double _work;
    private readonly double _terms;

    // Of the speeds that the forces give in a step.
    private readonly double _forced;

    /// <param name="batch">Built at the end pose.</param>
    /// <param name="dt">Step, s.</param>
    public Energy(Batch<ScalarLane> batch, double dt)
    {
        _kinetic = 0;
        _work = 0;
        _terms = 0;
        _forced = 0;
        double[] a = batch.Bodies;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = Batch<ScalarLane>.Body(body, 0);
            double mass = 1 / a[o + BodySlot.InverseMass];
            Vector3d w = Impulses<ScalarLane>.AngularVelocity(batch, body);
            for (int i = 0; i < 3; i++)
            {
                double v = a[o + BodySlot.V + i];
                double acceleration = a[o + BodySlot.Acceleration + i];
                double work = mass * acceleration * a[o + BodySlot.EndX + i];
                _kinetic += (mass * v * v + a[o + BodySlot.L + i] * w[i]) / 2;
                _work += work;
                _terms += Math.Abs(work);
                _forced += mass * acceleration * acceleration * dt * dt / 2;
            }
        }
    }

    /// <summary>Whether nothing does work on an island but its bodies' own constant forces.</summary>
    public static bool IsKnown(Batch<ScalarLane> batch)
    {
        bool isKnown = batch.Laws == null && batch.Shape.IsWorkless && !batch.Shape.IsInexact;
        for (int body = 0; body < batch.Shape.MovingBodies && isKnown; body++)
        {
            int o = Batch<ScalarLane>.Body(body, BodySlot.Torque);
            isKnown = batch.Bodies[o] == 0 && batch.Bodies[o + 1] == 0 && batch.Bodies[o + 2] == 0;
        }

        return isKnown;
    }

    /// <summary>Whether kinetic energy less work changed since by no more than a share of what moves, and rounding.</summary>
    public bool IsKept(in Energy since, double share)
    {
        double change = Math.Abs(_kinetic - since._kinetic - (_work - since._work));
        return change <= share * (_kinetic + _forced) + Rounding * (_terms + since._terms);
    }
}
