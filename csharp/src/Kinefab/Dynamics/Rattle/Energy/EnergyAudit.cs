using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Energy of an island on the only lane, J.</summary>
internal readonly struct EnergyAudit
{
    // Rounding of the forces' work, against its terms.
    private const double Rounding = 1e-12;

    // Rounding of a body's energy of turning, against its terms.
    private const double TurningRounding = 1e-15;

    // Tolerances by which a pose may be off that counts as closed: its own, its start's and what the chord leaves of other rows.
    private const double Tolerances = 10;

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
        _floor = (batch.ActiveSet?.LargestStoredEnergy(distance, dt) ?? 0) + CompliantAngles<ScalarLane>.LargestEnergy(batch, distance) + LargestReactions(batch, dt) * distance;
        _work = batch.Work.CompliantWork[0];
        _terms = 0;
        _forced = 0;
        _stored = batch.ActiveSet?.StoredEnergy(dt) ?? 0;
        _sprung = batch.ActiveSet?.SpringWork() ?? 0;
        _driven = batch.Work.DrivenWork;
        Kinetic = KineticOf(batch);
        Moving = MovingOf(batch, dt);
        double[] a = batch.Bodies;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, 0);
            double mass = 1 / a[o + BodyLanes.InverseMass];
            Vector3d acceleration = LaneTransfer<ScalarLane>.ReadVector(a, o + BodyLanes.Acceleration);
            Vector3d work = Vector3d.Scale(mass * acceleration, LaneTransfer<ScalarLane>.ReadVector(a, o + BodyLanes.EndX));
            _work += work.X + work.Y + work.Z;
            _terms += Math.Abs(work.X) + Math.Abs(work.Y) + Math.Abs(work.Z);
            _forced += mass * acceleration.LengthSquared * dt * dt / 2;
            _floor += TurningRounding * TurningTerms(a, o);
            double inverse = a[o + BodyLanes.LeastInverseInertia];
            _floor += (mass + (inverse > 0 ? 1 / inverse : 0)) * speed * speed + mass * acceleration.Length * distance;
        }
    }

    /// <summary>J.</summary>
    public double Kinetic { get; }

    /// <summary>The same, and at least what forces give in the first steps from rest, J.</summary>
    public double Moving { get; }

    /// <summary>
    /// Whether the work since the start of the step is known but for rounding, and J v is 0, so that one factor may change all speeds: not where motors
    /// or kinematic bodies moved the island, of which there is a bound, nor with springs without a potential, of which there is an estimate.
    /// </summary>
    public bool IsClosed => !(_driven > 0) && _sprung == 0;

    /// <summary>Whether springs hold energy: what a soft limit's damper takes of it where the joint leaves faster than the spring follows is lost without an impulse.</summary>
    public bool IsSprung => _stored > 0;

    /// <summary>Energy that came of nothing since, J.</summary>
    public double GainSince(in EnergyAudit since) => Change(since) - (_driven - since._driven);

    /// <summary><see cref="Kinetic"/> without an account of the rest.</summary>
    public static double KineticOf(LaneBatch<ScalarLane> batch) => NumberOf(LaneEnergy<ScalarLane>.Kinetic(batch), batch);

    /// <summary><see cref="Moving"/> without an account of the rest.</summary>
    /// <param name="batch">Built at the end pose.</param>
    /// <param name="dt">Step, s.</param>
    public static double MovingOf(LaneBatch<ScalarLane> batch, double dt) =>
        Math.Max(KineticOf(batch), NumberOf(LaneEnergy<ScalarLane>.FirstWork(batch, dt), batch));

    // Their work over a gap is energy that comes and goes. It shows where a loop is singular: the reactions there are any number of times as large as loads,
    // since what is within the tolerance leaves room for a way of the order of its root. Those of the step so far, or at its start those of the last one, whose
    // second half is what the impulses were loaded with, N and N m.
    private static double LargestReactions(LaneBatch<ScalarLane> batch, double dt)
    {
        double sum = 0;
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            int first = batch.Shape.Pattern.Rows[n];
            for (int row = first; row < first + batch.Shape.Blocks[n].BilateralCount; row++)
            {
                sum += Math.Max(Math.Abs(batch.Work.TotalImpulses[row]), 2 * Math.Abs(batch.VelocityImpulses[row]));
            }
        }

        return sum / dt;
    }

    // Of L W L without their signs: where a body does not turn about an axis, momentum about it leaves them nothing but rounding.
    private static double TurningTerms(double[] a, int o)
    {
        Vector3d l = LaneTransfer<ScalarLane>.ReadVector(a, o + BodyLanes.L);
        double x = Math.Abs(l.X), y = Math.Abs(l.Y), z = Math.Abs(l.Z);
        int w = o + BodyLanes.WorldInverse;
        return a[w] * x * x + a[w + 1] * y * y + a[w + 2] * z * z + 2 * (Math.Abs(a[w + 3]) * x * y + Math.Abs(a[w + 4]) * x * z + Math.Abs(a[w + 5]) * y * z);
    }

    /// <summary>Adds to the account the most that motors and kinematic bodies can have given by impulses, at the pose and for the time in which they gave them.</summary>
    /// <param name="batch">Built at the end pose of the part.</param>
    /// <param name="h">Its length, s.</param>
    /// <param name="impulses">Of all rows, N s or N m s.</param>
    public static void AddDriven(LaneBatch<ScalarLane> batch, double h, double[] impulses)
    {
        batch.Work.DrivenWork += batch.ActiveSet?.MotorWorkBound(h, impulses) ?? 0;
        if (batch.Shape.HasKinematic)
        {
            batch.ActiveSet?.WriteRows(true);
            batch.Work.DrivenWork += NumberOf(LaneEnergy<ScalarLane>.KinematicWorkBound(batch, impulses), batch);
            batch.ActiveSet?.WriteRows(false);
        }
    }

    private static double NumberOf(Lane<ScalarLane> lane, LaneBatch<ScalarLane> batch)
    {
        lane.Store(batch.Work.Leftover, 0);
        return batch.Work.Leftover[0];
    }

    /// <summary>Slows the bodies down until energy has not grown since by more than drives can have given.</summary>
    public void Dampen(LaneBatch<ScalarLane> batch, in EnergyAudit since)
    {
        double takeable = LaneEnergy<ScalarLane>.Takeable(batch, 0, Kinetic, out CommonMotion common);
        LaneEnergy<ScalarLane>.Take(batch, 0, Math.Max(0, GainSince(since)), takeable, common);
    }

    /// <summary>
    /// By how much energy less work changed since, against a share of what moves, once rounding is off. Where it may be lost, as to scalar rows, by how
    /// much it grew beyond what drives can have given. Up to 1 it is kept.
    /// </summary>
    public double Excess(in EnergyAudit since, bool mayLose, double share)
    {
        double change = Change(since);
        double rounding = Rounding * (_terms + since._terms) + Math.Max(_floor, since._floor);
        double excess = mayLose ? change - _driven - rounding : Math.Abs(change) - rounding;
        return excess <= 0 ? 0 : excess / Allowed(since, mayLose, share);
    }

    /// <summary>A share of what moves, J, see <see cref="Excess"/>.</summary>
    public double Allowed(in EnergyAudit since, bool mayLose, double share) =>
        share * (mayLose ? since.Kinetic + since._stored + Math.Abs(_sprung - since._sprung) + _forced : Kinetic + _forced);

    private double Change(in EnergyAudit since) =>
        Kinetic + _stored - since.Kinetic - since._stored - (_work - since._work) - (_sprung - since._sprung);
}
