using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

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

    // In springs; what those without potential gave since the start of the step, and an upper bound of what motors did.
    private readonly double _stored;
    private readonly double _sprung;
    private readonly double _driven;

    /// <param name="batch">Built at the end pose.</param>
    /// <param name="dt">Step, s.</param>
    public Energy(Batch<ScalarLane> batch, double dt)
    {
        _kinetic = 0;
        _work = 0;
        _terms = 0;
        _forced = 0;
        _stored = batch.Laws?.Stored(dt) ?? 0;
        _sprung = batch.Laws?.SpringWork() ?? 0;
        _driven = batch.Laws?.Driven() ?? 0;
        double[] a = batch.Bodies;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = Batch<ScalarLane>.Body(body, 0);
            double mass = 1 / a[o + BodySlot.InverseMass];
            Vector3d v = Transfer<ScalarLane>.Vector(a, o + BodySlot.V);
            Vector3d turning = Vector3d.Scale(Transfer<ScalarLane>.Vector(a, o + BodySlot.L), Impulses<ScalarLane>.AngularVelocity(batch, body));
            Vector3d acceleration = Transfer<ScalarLane>.Vector(a, o + BodySlot.Acceleration);
            Vector3d work = Vector3d.Scale(mass * acceleration, Transfer<ScalarLane>.Vector(a, o + BodySlot.EndX));
            _kinetic += (mass * v.LengthSquared + turning.X + turning.Y + turning.Z) / 2;
            _work += work.X + work.Y + work.Z;
            _terms += Math.Abs(work.X) + Math.Abs(work.Y) + Math.Abs(work.Z);
            _forced += mass * acceleration.LengthSquared * dt * dt / 2;
        }
    }

    /// <summary>Whether nothing does work on an island but its bodies' own constant forces and its laws.</summary>
    public static bool IsKnown(Batch<ScalarLane> batch)
    {
        bool isKnown = batch.Shape.IsWorkless && !batch.Shape.IsInexact;
        for (int body = 0; body < batch.Shape.MovingBodies && isKnown; body++)
        {
            int o = Batch<ScalarLane>.Body(body, BodySlot.Torque);
            isKnown = batch.Bodies[o] == 0 && batch.Bodies[o + 1] == 0 && batch.Bodies[o + 2] == 0;
        }

        return isKnown;
    }

    /// <summary>
    /// Whether energy less work changed since by no more than a share of what moves, and rounding. Where it may be lost, as
    /// to laws, whether it grew by no more than that and what drives can have given.
    /// </summary>
    public bool IsKept(in Energy since, bool mayLose, double share)
    {
        double sprung = _sprung - since._sprung;
        double change = _kinetic + _stored - since._kinetic - since._stored - (_work - since._work) - sprung;
        double rounding = Rounding * (_terms + since._terms);
        return mayLose
            ? change <= share * (since._kinetic + since._stored + Math.Abs(sprung) + _forced) + _driven + rounding
            : Math.Abs(change) <= share * (_kinetic + _forced) + rounding;
    }
}
