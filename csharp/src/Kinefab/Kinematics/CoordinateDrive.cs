using System;

namespace Kinefab.Kinematics;

/// <summary>
/// Continuation from a state to driven values: s goes from 0 to 1, all driven coordinates on straight lines; a step that
/// Newton's method does not follow is halved, and one that breaks a limit is cut at the contact and the limit held.
/// </summary>
internal sealed class CoordinateDrive
{
    // Radians, or lengths of the mechanism.
    private const double LargestStep = 0.35;
    private const double LeastStep = 1e-7;
    private const double LeastStepAtLimit = 1e-2;
    private const double LimitTolerance = 1e-12;
    private const int MaxContactIterations = 40;

    private readonly Mechanism _mechanism;
    private readonly NewtonSolver _newton;
    private readonly MechanismState _good;
    private readonly int[] _coordinates;
    private readonly double[] _from;
    private readonly double[] _to;
    private int _count;

    public CoordinateDrive(Mechanism mechanism, NewtonSolver newton)
    {
        _mechanism = mechanism;
        _newton = newton;
        _good = mechanism.NewState();
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
        while (s < 1)
        {
            double next = s + step >= 1 ? 1 : s + step;
            if (!Track(state, next))
            {
                state.CopyFrom(_good);
                step = (next - s) / 2;
                if (step * way > (limit >= 0 ? LeastStepAtLimit : LeastStep))
                {
                    continue;
                }

                return End(state, s, limit);
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
    private double Contact(MechanismState state, double inside, double outside, ref int limit)
    {
        double start = inside;
        LimitSet limits = _newton.Limits;
        double outer = limits.Distances[limit];
        limits.Measure(_good.Poses);
        double inner = Math.Max(limits.Distances[limit], 0);
        if (inner <= LimitTolerance)
        {
            state.CopyFrom(_good);
            return start;
        }

        double weight = 1;
        for (int n = 0; n < MaxContactIterations && outside - inside > 1e-16; n++)
        {
            double s = inner > 0 && !double.IsInfinity(inner) ? inside + (outside - inside) * (weight * inner / ((weight * inner) - outer)) : (inside + outside) / 2;
            state.CopyFrom(_good);
            if (!Track(state, s))
            {
                outside = s;
                continue;
            }

            limits.Measure(state.Poses);
            int broken = limits.Worst(LimitTolerance);
            if (broken >= 0)
            {
                if (broken != limit)
                {
                    limits.Measure(_good.Poses);
                    inner = Math.Max(limits.Distances[broken], 0);
                    inside = start;
                    limit = broken;
                    limits.Measure(state.Poses);
                }

                outside = s;
                outer = limits.Distances[limit];
                weight = 1;
            }
            else
            {
                inside = s;
                inner = Math.Max(limits.Distances[limit], 0);
                weight *= 0.5;
                if (inner <= LimitTolerance)
                {
                    return s;
                }
            }
        }

        state.CopyFrom(_good);
        if (!Track(state, inside))
        {
            state.CopyFrom(_good);
            return start;
        }

        return inside;
    }

    private DriveResult End(MechanismState state, double s, int limit)
    {
        _newton.ClearDriven();
        _newton.Motion.Start(state.Poses);
        _newton.Assemble(state);
        double error = Math.Max(_newton.Equations.Worst, _newton.Motion.WorstError);
        DriveStatus status = error > _newton.Accepted ? DriveStatus.NotClosed : limit >= 0 ? DriveStatus.StoppedByLimit : DriveStatus.OutOfReach;
        return Result(status, s, limit);
    }

    private DriveResult Result(DriveStatus status, double s, int limit) =>
        new(status, s, _newton.Iterations, _newton.ErrorMetres, _newton.ErrorDegrees, limit < 0 ? null : LimitNames.Of(_good, _newton.Limits, limit));
}
