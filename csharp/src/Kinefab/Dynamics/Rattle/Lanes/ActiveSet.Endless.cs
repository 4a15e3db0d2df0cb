using System;
using System.Collections.Generic;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>How much a drive without limit of force may need.</summary>
internal sealed partial class ActiveSet<V>
{
    // By how much the levers of a loop, and gears, may multiply what reaches a drive. More makes the answer of a drive that stalls so large that steps fail.
    private const double MostByLevers = 30;
    private const double MostByGears = 1e3;

    // Of a drive that nothing can follow, its speed is a millionth.
    private const int MostSlowdowns = 20;
    private const int Slowdown = 2;

    // In a step a drive to a goal begins with no more than this turn, rad, or this share of what the mechanism reaches.
    private const double MostTurn = 0.5;
    private const double MostWay = 0.1;

    // Of the speed that it was asked for, less is a drive that the mechanism does not follow.
    private const double LeastFollowed = 0.5;

    // What is reckoned of speeds and loads, this many times.
    private const double Margin = 4;

    /// <summary>
    /// The most impulse that a drive can need in a step, whatever way its island takes: to start, stop or turn round all bodies as one, and to hold out
    /// against springs, other drives and loads. Of a chain no more reaches it; levers and gears may multiply it.
    /// </summary>
    /// <param name="drive">Its row.</param>
    /// <param name="h">Step, s.</param>
    private double MostNeeded(in ScalarRow drive, double h)
    {
        const double mostAcceleration = 1e3;
        bool isAngular = drive.Built.Has(RowFlags.Angular);
        double speed = Math.Abs(drive.AskedSpeed(h));
        double levers = _batch.Shape.HasLoops ? MostByLevers : 1;
        Vector3d anchor = Anchor(drive);
        double reach = 0, mass = 0, moments = 0, momentum = 0, load = 0;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneRecords<V>.Body(body, 0);
            double own = Inverse(_batch.Bodies[o + BodyLanes.InverseMass]);
            double arm = Length(o + BodyLanes.EndX, anchor);
            double weight = isAngular ? own * arm : own;
            reach = Math.Max(reach, arm);
            mass += own;
            moments += own * arm * arm + Inverse(_batch.Bodies[o + BodyLanes.LeastInverseInertia]);
            momentum += weight * Length(o + BodyLanes.V) + (isAngular ? Length(o + BodyLanes.L) : 0);
            load += weight * Length(o + BodyLanes.Acceleration) + (isAngular ? Length(o + BodyLanes.Torque) : 0);
        }

        double inertia = isAngular ? moments : levers > 1 && reach > 0 ? mass + levers * moments / (reach * reach) : mass;
        double impulse = Margin * (inertia * speed + momentum + (load + levers * Opposed(drive, h, speed, reach)) * h) + inertia * mostAcceleration * Math.Sqrt(drive.Pace) * h;
        return ByGears(reach) * impulse;

    }

    // How far from a drive's joint the farthest body is, m.
    private double FarthestBody(in ScalarRow drive)
    {
        Vector3d anchor = Anchor(drive);
        double reach = 0;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            reach = Math.Max(reach, Length(LaneRecords<V>.Body(body, BodyLanes.EndX), anchor));
        }

        return reach;
    }

    private Vector3d Anchor(in ScalarRow drive) =>
        LaneTransfer<V>.ReadPose(_batch, _batch.Shape.Blocks[drive.Block].Bodies[0], 0).Point(_batch.Models[drive.Block]!.Frame0.Position);

    private double Length(int number, Vector3d from = default) => (LaneTransfer<V>.ReadVector(_batch.Bodies, number) - from).Length;

    /// <summary>
    /// Before a step: a drive to a goal far away does not begin with the whole speed that its gap asks for, lest what lies beyond the mechanism's reach
    /// throw it about; it may be <see cref="ScalarRow.SlowerBy"/> times faster in each step.
    /// </summary>
    /// <param name="dt">Step, s.</param>
    public void BeginPace(double dt)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (!scalar.IsEndlessDrive || Side(scalar.Built.VelocityTarget) == -scalar.SlowdownSide)
            {
                scalar.SlowDown(0);
            }

            if (!scalar.IsEndlessDrive || !scalar.Built.Has(RowFlags.Motion))
            {
                continue;
            }

            double most = Math.Max(scalar.Built.Has(RowFlags.Angular) ? MostTurn : MostWay * FarthestBody(scalar), ScalarRow.SlowerBy * dt * Math.Abs(StartSpeed(scalar)));
            double error = Math.Abs(scalar.Built.GeometricError);
            while (most > 0 && scalar.Slowdowns < MostSlowdowns && error - error / scalar.Growth(dt) > most)
            {
                scalar.SlowDown(scalar.Slowdowns + 1);
            }
        }
    }

    /// <summary>After a step: a drive without limit of force asks for less where the mechanism did not follow it, and for more again where it did.</summary>
    /// <param name="tolerance">m/s or rad/s.</param>
    /// <returns>Whether one is slowed down.</returns>
    public bool EndPace(double tolerance)
    {
        bool isAny = false;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (!scalar.IsEndlessDrive || scalar.IsHeld || !scalar.AsksForSpeed)
            {
                continue;
            }

            double asked = scalar.Built.VelocityTarget;
            scalar.SlowdownSide = Side(asked);
            bool isFollowed = !scalar.IsStalled && StartSpeed(scalar) * scalar.SlowdownSide >= LeastFollowed * Math.Abs(asked) - tolerance;
            scalar.SlowDown(isFollowed ? Math.Max(0, scalar.Slowdowns - 1) : Math.Min(MostSlowdowns, scalar.Slowdowns + Slowdown));
            isAny |= scalar.Slowdowns > 0;
        }

        return isAny;
    }

    // The sign of a speed; of no number none.
    private static int Side(double speed) => speed > 0 ? 1 : speed < 0 ? -1 : 0;

    /// <summary>Whether a drive has no limit of force.</summary>
    public bool HasEndless() => Array.Exists(_rows, row => row.IsEndlessDrive);

    /// <summary>Whether a drive is held, see <see cref="HeldDrives"/>.</summary>
    public bool HasHeld()
    {
        // Each step asks: no row is copied.
        int i = 0;
        while (i < _rows.Length && !_rows[i].IsHeld)
        {
            i++;
        }

        return i < _rows.Length;
    }

    /// <summary>Indices of the drives without limit of force, of which none is held or opposes one yet.</summary>
    public int[] EndlessDrives()
    {
        var found = new List<int>();
        for (int i = 0; i < _rows.Length; i++)
        {
            _rows[i].IsHeld = false;
            _rows[i].IsOpposing = false;
            if (_rows[i].IsEndlessDrive)
            {
                found.Add(i);
            }
        }

        return found.ToArray();
    }

    /// <summary>Notes that a drive is held.</summary>
    public void Hold(int index) => _rows[index].IsHeld = true;

    /// <summary>Notes that a drive takes part in holding one.</summary>
    public void Oppose(int index) => _rows[index].IsOpposing = true;

    /// <summary>Whether a drive that opposes others holds one that stalls.</summary>
    public bool HasHeldStalled() => Array.Exists(_rows, row => row.IsHeld && row.IsStalled);

    // By how much gears may multiply an inertia, by the square of their ratios, or a load, by less. reach: of angles, by which they compare with ways, m.
    private double ByGears(double reach)
    {
        double product = 1;
        foreach (CoordinateCoupling? coupling in _batch.Couplings)
        {
            double least = double.PositiveInfinity, most = 0;
            for (int i = 0; coupling != null && i < coupling.Factors.Length; i++)
            {
                double factor = Math.Abs(coupling.Factors[i]);
                factor /= coupling.Coordinates[i].IsAngle && reach > 0 ? reach : 1;
                least = factor > 0 ? Math.Min(least, factor) : least;
                most = Math.Max(most, factor);
            }

            product *= most > least ? most / least * (most / least) : 1;
        }

        return Math.Min(product, MostByGears);
    }

    // What springs and the drives whose force has a limit may hold against a drive, N or N m of its own.
    private double Opposed(in ScalarRow drive, double h, double speed, double reach)
    {
        double sum = 0;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow other = ref _rows[i];
            bool isSpring = other.Built.Has(RowFlags.Spring);
            if (!other.IsActive || other.Index == drive.Index || !(isSpring || (other.Built.Has(RowFlags.Drive) && !other.IsEndless)))
            {
                continue;
            }

            double gain = other.Built.Has(RowFlags.AccelerationSpring) ? Inverse(Response(other)) : 1;
            double way = Math.Abs(other.Built.GeometricError) + Margin * h * speed;
            double force = isSpring
                ? gain * (other.Built.Stiffness * way + other.Built.Damping * (Math.Abs(other.StartSpeed) + Margin * speed))
                : Math.Max(other.Built.Maximum, -other.Built.Minimum);
            bool turns = other.Built.Has(RowFlags.Angular), isAngular = drive.Built.Has(RowFlags.Angular);
            sum += turns == isAngular || reach == 0 ? force : turns ? force / reach : force * reach;
        }

        return sum;
    }

    private static double Inverse(double number) => number > 0 ? 1 / number : 0;
}
