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

    // By how much one joint's angles, whose axes are not at right angles, may work against each other.
    private const double MostBySkew = 4;

    // How often the speed of one that the mechanism does not follow is halved in a step.
    private const int Slowdown = 2;

    // Of the speed that it was asked for at first, one that gains more in a step still comes, and one that has less stands, if it also turns by less in a
    // step, rad, or moves by less of what the mechanism reaches.
    private const double LeastMoved = 1e-2;
    private const double LeastWay = 1e-4;

    // In a step a drive to a goal begins with no more than this turn, rad, or this share of what the mechanism reaches.
    private const double MostTurn = 0.5;
    private const double MostWay = 0.1;

    // Growth of the inertia in a step from which on it comes to a dead point: it grows no faster, or it slows down.
    private const double Heavier = 1.2;
    private const double MostHeavier = 1.5;

    // Of the speed that it was asked for, less is a drive that the mechanism does not follow.
    private const double LeastFollowed = 0.5;

    // What is reckoned of speeds and loads, this many times.
    private const double Margin = 4;

    /// <summary>
    /// The most impulse that a drive can need in a part of a step, whatever way its island takes: to start, stop or turn round all bodies as one, which is
    /// a matter of the whole step, by itself or as other drives ask for, and to hold out against springs, other drives, loads and what turns. Of a chain no
    /// more reaches it; levers and gears may multiply it. In loops what the bodies have beside the speeds that are asked for does not count: where a dead
    /// point throws them about, each step would throw them farther.
    /// </summary>
    /// <param name="drive">Its row.</param>
    /// <param name="h">Length of the part, s.</param>
    private double MostNeeded(in ScalarRow drive, double h)
    {
        const double mostAcceleration = 1e3;
        bool isAngular = drive.Built.Has(RowFlags.Angular);
        double speed = Math.Abs(drive.AskedSpeed(h));
        double inertia = MostInertia(drive, out double reach), load = 0, weights = 0;
        Vector3d anchor = Anchor(drive);
        FindOthers(drive, out double turning, out double moving);
        double fastestTurn = turning + (isAngular ? speed : 0), fastest = moving + (isAngular ? 0 : speed);
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneRecords<V>.Body(body, 0);
            double own = Inverse(_batch.Bodies[o + BodyLanes.InverseMass]);
            double weight = isAngular ? own * Length(o + BodyLanes.EndX, anchor) : own;
            weights += weight;
            load += weight * Length(o + BodyLanes.Acceleration) + (isAngular ? Length(o + BodyLanes.Torque) : 0);
            fastestTurn = _batch.Shape.HasJointLoops ? fastestTurn : Math.Max(fastestTurn, Impulses<V>.AngularVelocity(_batch, body).Length);
            fastest = _batch.Shape.HasJointLoops ? fastest : Math.Max(fastest, Length(o + BodyLanes.V));
        }

        // Towards the axes about which it turns, and as it slides while it turns.
        load += weights * fastestTurn * (fastestTurn * reach + 2 * fastest) + (isAngular ? inertia * fastestTurn * fastestTurn : 0);
        double others = isAngular ? inertia * turning + weights * moving : inertia * (moving + turning * reach);
        double start = Math.Max(0, Margin * (inertia * (speed + Math.Abs(drive.StartSpeed)) + others) - Math.Abs(_batch.Work.TotalImpulses[drive.Index]));
        double force = Margin * (load + Levers * Opposed(drive, h, speed, reach)) + inertia * mostAcceleration * Math.Sqrt(drive.Pace.Share);
        return ByGears(reach) * (isAngular && AreAskew(drive) ? MostBySkew : 1) * (start + force * h);
    }

    // Whether the joint has other angular drives without limit of force: its angles do not turn about axes at right angles, and what one asks for the others
    // undo.
    private bool AreAskew(in ScalarRow drive)
    {
        bool areAskew = false;
        int first = _scalars.First(drive.Block);
        for (int i = first; i < first + _batch.Shape.Blocks[drive.Block].ScalarCount; i++)
        {
            areAskew |= _rows[i].IsEndlessDrive && _rows[i].Built.Has(RowFlags.Angular) && _rows[i].Index != drive.Index;
        }

        return areAskew;
    }

    // How fast the other drives without limit of force and the kinematic bodies turn the island, rad/s, and move it, m/s: as they are asked to and as they do.
    private void FindOthers(in ScalarRow drive, out double turning, out double moving)
    {
        turning = 0;
        moving = 0;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow other = ref _rows[i];
            double speed = other.IsEndlessDrive && !other.Drive.IsHeld && other.Index != drive.Index ? Math.Abs(other.Built.VelocityTarget) + Math.Abs(StartSpeed(other)) : 0;
            turning += other.Built.Has(RowFlags.Angular) ? speed : 0;
            moving += other.Built.Has(RowFlags.Angular) ? 0 : speed;
        }

        for (int body = _batch.Shape.MovingBodies; body < _batch.Shape.Bodies.Length; body++)
        {
            int o = LaneRecords<V>.Body(body, 0);
            turning += _batch.Shape.IsStatic[body] ? 0 : Length(o + BodyLanes.W);
            moving += _batch.Shape.IsStatic[body] ? 0 : Length(o + BodyLanes.V);
        }
    }

    private double Levers => _batch.Shape.HasLoops ? MostByLevers : 1;

    // The most that a mechanism away from its dead points is to a drive that moves it, kg or kg m^2, but for gears: all bodies as one. reach: how far the
    // farthest is from the drive's joint, m.
    private double MostInertia(in ScalarRow drive, out double reach)
    {
        Vector3d anchor = Anchor(drive);
        double mass = 0, moments = 0;
        reach = 0;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneRecords<V>.Body(body, 0);
            double own = Inverse(_batch.Bodies[o + BodyLanes.InverseMass]), arm = Length(o + BodyLanes.EndX, anchor);
            reach = Math.Max(reach, arm);
            mass += own;
            moments += own * arm * arm + Inverse(_batch.Bodies[o + BodyLanes.LeastInverseInertia]);
        }

        double levers = Levers;
        return drive.Built.Has(RowFlags.Angular) ? moments : levers > 1 && reach > 0 ? mass + levers * moments / (reach * reach) : mass;
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
    /// throw it about; it may be <see cref="DrivePace.SlowerBy"/> times faster in each step.
    /// </summary>
    /// <param name="dt">Step, s.</param>
    public void BeginPace(double dt)
    {
        HasRunAway = false;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            ref DrivePace pace = ref scalar.Pace;
            if (!scalar.IsEndlessDrive || Side(scalar.Built.VelocityTarget) == -pace.Side)
            {
                scalar.SlowDown(0);
            }

            pace.StartSpeed = scalar.IsEndlessDrive ? StartSpeed(scalar) : 0;
            if (!scalar.IsEndlessDrive || !scalar.Built.Has(RowFlags.Motion))
            {
                continue;
            }

            double most = Math.Max(scalar.Built.Has(RowFlags.Angular) ? MostTurn : MostWay * FarthestBody(scalar), DrivePace.SlowerBy * dt * Math.Abs(pace.StartSpeed));
            double error = Math.Abs(scalar.Built.GeometricError);
            while (most > 0 && pace.Slowdowns < DrivePace.MostSlowdowns && error - error / scalar.Growth(dt) > most)
            {
                scalar.SlowDown(pace.Slowdowns + 1);
            }
        }
    }

    /// <summary>Within a step whose parts fail: the drives without limit of force ask for less from here on; whether there are such.</summary>
    public bool SlowDown()
    {
        bool isAny = false;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (scalar.IsEndlessDrive && !scalar.Drive.IsHeld && scalar.AsksForSpeed && scalar.Pace.Slowdowns < DrivePace.MostSlowdowns)
            {
                scalar.SlowDown(Math.Min(DrivePace.MostSlowdowns, scalar.Pace.Slowdowns + Slowdown));
                scalar.Pace.IsSlowedWithin = true;
                isAny = true;
            }
        }

        return isAny;
    }

    /// <summary>
    /// After a step: a drive without limit of force asks for less where the mechanism did not follow it, for nothing where it stood, and for more again
    /// where it was followed.
    /// </summary>
    /// <param name="dt">Step, s.</param>
    /// <param name="tolerance">m/s or rad/s.</param>
    /// <param name="comesToRest">Whether one stood and rests from now on.</param>
    /// <returns>Whether one is slowed down.</returns>
    public bool EndPace(double dt, double tolerance, out bool comesToRest)
    {
        bool isAny = false;
        comesToRest = false;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (!scalar.IsEndlessDrive || scalar.Drive.IsHeld || !scalar.AsksForSpeed)
            {
                continue;
            }

            ref DrivePace pace = ref scalar.Pace;
            double asked = Math.Abs(scalar.Built.VelocityTarget);
            pace.Side = Side(scalar.Built.VelocityTarget);
            double speed = StartSpeed(scalar) * pace.Side;
            bool isFollowed = !scalar.Drive.IsStalled && speed >= LeastFollowed * asked - tolerance;
            double little = LeastMoved * asked / pace.Share;
            bool comes = speed > Math.Max(0, pace.StartSpeed * pace.Side) + little;
            double growth = GrowthAtADeadPoint(ref scalar);
            bool stands = scalar.Drive.IsStalled && Math.Abs(speed) <= little
                && Math.Abs(speed) * dt <= LeastWay * (scalar.Built.Has(RowFlags.Angular) ? 1 : FarthestBody(scalar));
            int before = pace.Slowdowns;
            bool rests = pace.Rests;
            pace.FollowedSlowdowns = isFollowed && !rests ? before : pace.FollowedSlowdowns;
            scalar.SlowDown(isFollowed && growth > MostHeavier ? Math.Min(DrivePace.MostSlowdowns, before + 1)
                : isFollowed ? Math.Max(0, before - (growth > Heavier || pace.IsSlowedWithin ? 0 : 1))
                : stands || rests ? DrivePace.Resting
                : comes ? before
                : Math.Min(DrivePace.MostSlowdowns, before + Slowdown));

            // Not silently: it is named as one that stalls.
            scalar.Drive.IsStalled |= isFollowed && (growth > MostHeavier || pace.IsSlowedWithin);
            pace.IsSlowedWithin = false;
            pace.HasRested = pace.Rests;
            isAny |= pace.Slowdowns > 0;
            pace.RestingFreedom = rests ? pace.RestingFreedom : double.NaN;
            comesToRest |= before < pace.Slowdowns && pace.Slowdowns == DrivePace.Resting;
        }

        if (comesToRest)
        {
            ForgetImpulses();
        }

        return isAny;
    }

    // By how much what the mechanism is to a drive that moves it grew in the step, where that is more than it comes to away from dead points: the pivot of
    // the drive's row, 1 / (J M^-1 J^T) once all other rows that act have answered. At a dead point it is infinite. 1 elsewhere.
    private double GrowthAtADeadPoint(ref ScalarRow drive)
    {
        double before = drive.Pace.Inertia;
        drive.Pace.Inertia = 0;
        if (drive.State == RowState.Free && drive.ProjectedAs == ProjectedAs.Rigid && _scalars.IsFactored)
        {
            double[] unit = _batch.Work.Solution;
            Array.Clear(unit, 0, unit.Length);
            unit[drive.Index] = 1;
            DelassusMatrix<V>.Solve(_batch, unit);
            drive.Pace.Inertia = unit[drive.Index];
        }

        double most = ByGears(0) * MostInertia(drive, out _) * (IsCoupledAmongOthers(drive) ? MostBySkew : 1);
        return before > 0 && drive.Pace.Inertia > most ? drive.Pace.Inertia / before : 1;
    }

    // Whether a coupling holds an angle of a drive's joint that turns about other axes too: of coupled angles, whose axes are not at right angles, one may turn
    // much where the other turns little.
    private bool IsCoupledAmongOthers(in ScalarRow drive) => _batch.Models[drive.Block] is D6Joint { IsCoupledAmongOthers: true };

    // A drive that gave all it has and what stopped it hold each other by far more than they have to. As a guess that would stay, since rows that agree ask
    // for no other; and shorter steps, which it made needful, no longer are.
    private void ForgetImpulses()
    {
        Array.Clear(_batch.VelocityImpulses, 0, _batch.VelocityImpulses.Length);
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            _batch.Bodies[LaneRecords<V>.Body(body, BodyLanes.Stiffness)] = 0;
        }

        for (int i = 0; i < _rows.Length; i++)
        {
            _rows[i].ImpulseFirstHalf = 0;
        }
    }

    // The sign of a speed; of no number none.
    private static int Side(double speed) => speed > 0 ? 1 : speed < 0 ? -1 : 0;

    /// <summary>Drives that were about to try again after a rest go on resting; whether there are such.</summary>
    public bool RestOn()
    {
        bool isAny = false;
        for (int i = NextResting(0); i >= 0; i = NextResting(i + 1))
        {
            isAny |= _rows[i].Pace.Slowdowns < DrivePace.Resting;
            _rows[i].SlowDown(DrivePace.Resting);
        }

        if (isAny)
        {
            ForgetImpulses();
        }

        return isAny;
    }

    /// <summary>The next row, from one on, of a drive that rests; -1: there is none.</summary>
    public int NextResting(int from)
    {
        int i = from;
        while (i < _rows.Length && !(_rows[i].Pace.Rests && _rows[i].IsEndlessDrive))
        {
            i++;
        }

        return i < _rows.Length ? i : -1;
    }

    /// <summary>Notes what freedom a drive came to rest with, see <see cref="HeldDrives.Wake"/>.</summary>
    public void NoteFreedom(int index, double freedom) => _rows[index].Pace.RestingFreedom = freedom;

    /// <summary>A drive that rests goes on.</summary>
    public void Wake(int index) => _rows[index].SlowDown(_rows[index].Pace.AwakeSlowdowns);

    /// <summary>Holds the hard limits that are reached where the rows were last built, and nothing else.</summary>
    /// <param name="reach">C up to which a limit counts as reached, m or rad.</param>
    public void HoldReached(double reach)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            bool isReached = scalar.IsActive && scalar.Built.IsHardLimit && scalar.Built.GeometricError <= reach;
            scalar.Kind = isReached ? RowKind.Limit : RowKind.None;
            scalar.State = isReached ? RowState.Free : RowState.AtBound;
        }
    }

    /// <summary>Lets go of the limits that draw; true when one did.</summary>
    /// <param name="impulses">Of all rows.</param>
    public bool LetGoOfDrawing(double[] impulses)
    {
        bool isAny = false;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (scalar.State == RowState.Free && impulses[scalar.Index] < 0)
            {
                scalar.State = RowState.AtBound;
                isAny = true;
            }
        }

        return isAny;
    }

    /// <summary>Whether a drive has no limit of force.</summary>
    public bool HasEndless() => Array.Exists(_rows, row => row.IsEndlessDrive);

    /// <summary>Whether a drive is held, see <see cref="HeldDrives"/>.</summary>
    public bool HasHeld()
    {
        // Each step asks: no row is copied.
        int i = 0;
        while (i < _rows.Length && !_rows[i].Drive.IsHeld)
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
            _rows[i].Drive.IsHeld = false;
            _rows[i].Drive.IsOpposing = false;
            if (_rows[i].IsEndlessDrive && Response(_rows[i]) > ScalarRow.LeastResponse)
            {
                found.Add(i);
            }
        }

        return found.ToArray();
    }

    /// <summary>Notes that a drive is held.</summary>
    public void Hold(int index) => _rows[index].Drive.IsHeld = true;

    /// <summary>Notes that a drive takes part in holding one.</summary>
    public void Oppose(int index) => _rows[index].Drive.IsOpposing = true;

    /// <summary>Whether a drive that opposes others holds one that stalls.</summary>
    public bool HasHeldStalled() => Array.Exists(_rows, row => row.Drive.IsHeld && row.Drive.IsStalled);

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
