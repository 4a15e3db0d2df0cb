using System;

namespace Kinefab.Kinematics;

/// <summary>
/// Continuation from a state to driven values: s goes from 0 to 1, all driven coordinates on straight lines; a step that
/// Newton's method does not follow is halved, and one that breaks a limit is cut at the contact and the limit held.
/// Where halving does not help, branches may cross: there the way is kept by a leap.
/// </summary>
internal sealed class CoordinateDrive
{
    // Radians, or lengths of the mechanism.
    private const double LargestStep = 0.35;
    private const double LeastStep = 1e-7;
    private const double LeastStepAtLimit = 1e-2;
    private const double LeapStep = 2e-2;
    private const double LimitTolerance = 1e-12;
    private const int MaxContactIterations = 40;

    private readonly Mechanism _mechanism;
    private readonly NewtonSolver _newton;
    private readonly MechanismState _good;
    private readonly int[] _coordinates;
    private readonly double[] _from;
    private readonly double[] _to;
    private readonly BranchLeap _leap;
    private int _count;

    public CoordinateDrive(Mechanism mechanism, NewtonSolver newton)
    {
        _mechanism = mechanism;
        _newton = newton;
        _good = mechanism.NewState();
        _leap = new BranchLeap(mechanism, newton);
        _coordinates = new int[mechanism.Coordinates.Count];
        _from = new double[_coordinates.Length];
        _to = new double[_coordinates.Length];
    }

    public DriveResult Run(MechanismState state, ReadOnlySpan<CoordinateTarget> targets)
    {
        _newton.Iterations = 0;
        double way = Aim(state, targets);
        _newton.Limits.Begin(state.Poses);
        _good.CopyFrom(state);
        double s = 0;
        double step = way > LargestStep ? LargestStep / way : 1;
        int limit = -1;
        double leaptFrom = -1;
        while (s < 1)
        {
            double next = s + step >= 1 ? 1 : s + step;
            if (!Track(state, next))
            {
                state.CopyFrom(_good);
                step = (next - s) / 2;
                bool leaps = limit < 0 && step * way <= LeapStep && s > leaptFrom;
                leaptFrom = leaps ? s : leaptFrom;
                if (!leaps || !_leap.TryOver(state, _coordinates.AsSpan(0, _count), _from, _to, s, way, out next))
                {
                    if (step * way <= (limit >= 0 ? LeastStepAtLimit : LeastStep))
                    {
                        return End(state, s, limit);
                    }

                    continue;
                }
            }

            _newton.Limits.Measure(state.Poses);
            int broken = _newton.Limits.Worst(LimitTolerance);
            if (broken >= 0)
            {
                next = Contact(state, s, next, ref broken);
                limit = broken;
                _newton.Limits.IsActive[broken] = true;
            }

            s = next;
            Array.Copy(_good.Values, state.Trail, state.Trail.Length);
            _good.CopyFrom(state);
            step = Math.Min(step * 2, Math.Max(LargestStep / Math.Max(way, LargestStep), 1e-300));
        }

        return Result(DriveStatus.Reached, 1, limit);
    }

    private double Aim(MechanismState state, ReadOnlySpan<CoordinateTarget> targets)
    {
        _count = targets.Length;
        double way = 0;
        for (int i = 0; i < _count; i++)
        {
            MechanismCoordinate coordinate = _mechanism.Coordinates[targets[i].Coordinate];
            _coordinates[i] = targets[i].Coordinate;
            _from[i] = state.Values[targets[i].Coordinate];
            _to[i] = coordinate.ToInternal(targets[i].Value);
            way = Math.Max(way, Math.Abs(_to[i] - _from[i]) / (coordinate.IsAngle ? 1 : _mechanism.Length));
        }

        return way;
    }

    private bool Track(MechanismState state, double s)
    {
        _newton.ClearDriven();
        for (int i = 0; i < _count; i++)
        {
            _newton.Drive(_coordinates[i], s >= 1 ? _to[i] : _from[i] + s * (_to[i] - _from[i]));
        }

        return _newton.Track(state);
    }

    // The s at which the first limit is met: false position with Illinois' halving between a pose inside and one outside.
    // Another limit may turn out to be met earlier; then that one is looked for.
    private double Contact(MechanismState state, double start, double outside, ref int limit)
    {
        LimitSet limits = _newton.Limits;
        double inside = start;
        double outer = limits.Distances[limit];
        limits.Measure(_good.Poses);
        double inner = limits.Distances[limit];
        int kept = 0;
        for (int n = 0; n < MaxContactIterations && inner > LimitTolerance && outside - inside > 1e-16; n++)
        {
            double share = double.IsInfinity(inner) ? 0.5 : inner / (inner - outer);
            double s = inside + (outside - inside) * share;
            state.CopyFrom(_good);
            if (!Track(state, s))
            {
                outside = s;
                continue;
            }

            limits.Measure(state.Poses);
            int broken = limits.Worst(LimitTolerance);
            if (broken >= 0 && broken != limit)
            {
                limit = broken;
                outer = limits.Distances[limit];
                limits.Measure(_good.Poses);
                inner = limits.Distances[limit];
                (inside, outside, kept) = (start, s, 0);
            }
            else if (broken >= 0)
            {
                inner *= kept < 0 ? 0.5 : 1;
                (outside, outer, kept) = (s, limits.Distances[limit], -1);
            }
            else if (limits.Distances[limit] <= LimitTolerance)
            {
                return s;
            }
            else
            {
                outer *= kept > 0 ? 0.5 : 1;
                (inside, inner, kept) = (s, limits.Distances[limit], 1);
            }
        }

        state.CopyFrom(_good);
        if (inside > start && Track(state, inside))
        {
            return inside;
        }

        state.CopyFrom(_good);
        return start;
    }

    private DriveResult End(MechanismState state, double s, int limit)
    {
        _newton.ClearDriven();
        _newton.Motion.Start(state.Poses);
        _newton.Assemble(state);
        double error = Math.Max(Math.Max(_newton.Equations.WorstLinear, _newton.Equations.WorstAngular), _newton.Motion.WorstError);
        DriveStatus status = error > _newton.Accepted ? DriveStatus.NotClosed : limit >= 0 ? DriveStatus.StoppedByLimit : DriveStatus.OutOfReach;
        return Result(status, s, limit);
    }

    private DriveResult Result(DriveStatus status, double s, int limit) =>
        new(status, s, _newton.Iterations, _newton.ErrorMetres, _newton.ErrorDegrees, limit < 0 ? null : LimitNames.Of(_good, _newton.Limits, limit));
}
