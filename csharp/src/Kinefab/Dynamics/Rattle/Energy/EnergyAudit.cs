using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Energy of an island on the only lane, J.</summary>
internal readonly struct EnergyAudit
{
    // Rounding of the forces' work, against its terms.
    private const double Rounding = 1e-12;

    // Tolerances by which a pose may be off that counts as closed: its own, its start's and what the chord leaves of other rows.
    private const double Tolerances = 10;

    private readonly double _kinetic;
    private readonly double _work;
    private readonly double _terms;

    // Of the speeds that the forces give in a step.
    private readonly double _forced;

    // In springs; what those without potential gave since the start of the step, and an upper bound of what motors and kinematic bodies did.
    private readonly double _stored;
    private readonly double _sprung;
    private readonly double _driven;

    // What a pose holds that is off by so much: of a mechanism at rest that is all there is.
    private readonly double _floor;

    /// <param name="batch">Built at the end pose.</param>
    /// <param name="dt">Step, s.</param>
    /// <param name="tolerance">Largest C, m or rad.</param>
    public EnergyAudit(LaneBatch<ScalarLane> batch, double dt, double tolerance)
    {
        double distance = Tolerances * tolerance;
        double speed = distance / dt;
        _floor = batch.ActiveSet?.LargestStoredEnergy(distance) ?? 0;
        _kinetic = 0;
        _work = 0;
        _terms = 0;
        _forced = 0;
        _stored = batch.ActiveSet?.StoredEnergy(dt) ?? 0;
        _sprung = batch.ActiveSet?.SpringWork() ?? 0;
        _driven = (batch.ActiveSet?.MotorWorkBound(dt) ?? 0) + KinematicWorkBound(batch);
        double[] a = batch.Bodies;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, 0);
            double mass = 1 / a[o + BodyLanes.InverseMass];
            Vector3d v = LaneTransfer<ScalarLane>.ReadVector(a, o + BodyLanes.V);
            Vector3d turning = Vector3d.Scale(LaneTransfer<ScalarLane>.ReadVector(a, o + BodyLanes.L), Impulses<ScalarLane>.AngularVelocity(batch, body));
            Vector3d acceleration = LaneTransfer<ScalarLane>.ReadVector(a, o + BodyLanes.Acceleration);
            Vector3d work = Vector3d.Scale(mass * acceleration, LaneTransfer<ScalarLane>.ReadVector(a, o + BodyLanes.EndX));
            _kinetic += (mass * v.LengthSquared + turning.X + turning.Y + turning.Z) / 2;
            _work += work.X + work.Y + work.Z;
            _terms += Math.Abs(work.X) + Math.Abs(work.Y) + Math.Abs(work.Z);
            _forced += mass * acceleration.LengthSquared * dt * dt / 2;
            _floor += (mass + 1 / a[o + BodyLanes.LeastInverseInertia]) * speed * speed + mass * acceleration.Length * distance;
        }

        Moving = _kinetic + ReadForced(batch, dt);
    }

    /// <summary>What moves, J, with what forces give to what only begins to.</summary>
    public double Moving { get; }

    /// <summary>By how much energy grew since beyond what forces and springs gave and drives may have given, J.</summary>
    public double GainSince(in EnergyAudit since) =>
        _kinetic + _stored - since._kinetic - since._stored - (_work - since._work) - (_sprung - since._sprung) - (_driven - since._driven);

    /// <summary>Whether nothing does work on an island but its bodies' own constant forces, its scalar rows and kinematic bodies.</summary>
    public static bool IsKnown(LaneBatch<ScalarLane> batch)
    {
        bool isKnown = !batch.Shape.IsInconsistent;
        for (int body = 0; body < batch.Shape.MovingBodies && isKnown; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, BodyLanes.Torque);
            isKnown = batch.Bodies[o] == 0 && batch.Bodies[o + 1] == 0 && batch.Bodies[o + 2] == 0;
        }

        return isKnown;
    }

    private static double ReadForced(LaneBatch<ScalarLane> batch, double dt)
    {
        LaneEnergy<ScalarLane>.Forced(batch, dt).Store(batch.Work.Moving, 0);
        return batch.Work.Moving[0];
    }

    // Each row's impulse since the start of the step at the speed that the kinematic bodies have along it, which is theirs for the whole step.
    private static double KinematicWorkBound(LaneBatch<ScalarLane> batch)
    {
        if (!batch.Shape.HasKinematic)
        {
            return 0;
        }

        double[] speeds = batch.Work.Solution;
        double[] without = batch.Work.LastSolution;
        batch.ActiveSet?.WriteRows(true);
        Impulses<ScalarLane>.NegativeSpeeds(batch, false);
        Array.Copy(speeds, without, speeds.Length);
        Impulses<ScalarLane>.NegativeSpeeds(batch);
        batch.ActiveSet?.WriteRows(false);
        double sum = 0;
        for (int i = 0; i < speeds.Length; i++)
        {
            sum += Math.Abs((speeds[i] - without[i]) * batch.Work.TotalImpulses[i]);
        }

        return sum;
    }

    /// <summary>Slows the bodies down until energy has not grown since by more than drives can have given.</summary>
    public void Dampen(LaneBatch<ScalarLane> batch, in EnergyAudit since)
    {
        double gain = GainSince(since);
        if (!(gain > 0) || !(_kinetic > 0))
        {
            return;
        }

        double share = Math.Sqrt(Math.Max(0, 1 - gain / _kinetic));
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, BodyLanes.V);
            for (int i = 0; i < 6; i++)
            {
                batch.Bodies[o + i] *= share;
            }
        }
    }

    /// <summary>
    /// Whether energy less work changed since by no more than a share of what moves, and rounding. Where it may be lost, as
    /// to scalar rows, whether it grew by no more than that and what drives can have given.
    /// </summary>
    public bool IsKept(in EnergyAudit since, bool mayLose, double share)
    {
        double sprung = _sprung - since._sprung;
        double change = _kinetic + _stored - since._kinetic - since._stored - (_work - since._work) - sprung;
        double rounding = Rounding * (_terms + since._terms) + _floor;
        return mayLose
            ? change <= share * (since._kinetic + since._stored + Math.Abs(sprung) + _forced) + _driven + rounding
            : Math.Abs(change) <= share * (_kinetic + _forced) + rounding;
    }
}
