using System;
using System.Collections.Generic;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <content>Drives without limit of force: how fast they go from step to step, and which of them rest or are held.</content>
internal sealed partial class ActiveSet<V>
    where V : struct, ILane<V>
{
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

            double most = Math.Max(scalar.Built.Has(RowFlags.Angular) ? MostTurn : MostWay * _needs.FarthestBody(scalar), DrivePace.SlowerBy * dt * Math.Abs(pace.StartSpeed));
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
                && Math.Abs(speed) * dt <= LeastWay * (scalar.Built.Has(RowFlags.Angular) ? 1 : _needs.FarthestBody(scalar));
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

        double most = _needs.MostPivot(drive);
        return before > 0 && drive.Pace.Inertia > most ? drive.Pace.Inertia / before : 1;
    }

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
}
