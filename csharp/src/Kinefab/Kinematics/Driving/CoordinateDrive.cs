using System;
using System.Collections.Generic;
using System.Threading;

namespace Kinefab.Kinematics;

/// <summary>
/// Continuation from a state to driven values: s goes from 0 to 1, all driven coordinates on straight lines; a step that
/// Newton's method does not follow is halved, and one that breaks a limit is cut at the contact and the limit held.
/// Where halving does not help, branches may cross: there the way is kept by a leap, or looked for where there is none yet.
/// </summary>
internal sealed class CoordinateDrive
{
    /// <summary>Steps from this on may cross branches, radians or lengths of the mechanism.</summary>
    public const double LeapStep = 2e-2;

    // Radians, or lengths of the mechanism.
    private const double LargestStep = 0.35;
    private const double LeastStep = 1e-7;
    private const double LeastStepAtLimit = 1e-2;
    private const double LimitTolerance = 1e-12;
    private const int MaxContactIterations = 40;

    // Ends a creep along a mechanism that is singular at every pose; beside what the way takes by itself.
    private const int MaxSteps = 500;
    private const double StepsOfTheWay = 20;

    private readonly Mechanism _mechanism;
    private readonly NewtonSolver _newton;
    private readonly MechanismState _good;
    private readonly MechanismState _before;
    private readonly int[] _coordinates;
    private readonly double[] _from;
    private readonly double[] _to;
    private readonly double[] _first;
    private readonly BifurcationStep _leap;
    private readonly BifurcationPoint _crossing;
    private BranchSearch? _search;
    private int _count;
    private int _branches;
    private bool _isFresh;

    public CoordinateDrive(Mechanism mechanism, NewtonSolver newton)
    {
        _mechanism = mechanism;
        _newton = newton;
        _good = mechanism.NewState();
        _before = mechanism.NewState();
        var straight = new TreeExtrapolation(mechanism, newton);
        _leap = new BifurcationStep(mechanism, newton, straight);
        _crossing = new BifurcationPoint(mechanism, newton, straight);
        Singular = new RankDeficiency(mechanism, newton);
        _coordinates = new int[mechanism.Coordinates.Count];
        _from = new double[_coordinates.Length];
        _to = new double[_coordinates.Length];
        _first = new double[_coordinates.Length];
    }

    public RankDeficiency Singular { get; }

    public DriveResult Run(MechanismState state, ReadOnlySpan<CoordinateTarget> targets, CancellationToken cancellation)
    {
        _newton.Iterations = 0;
        _newton.BeginTracks();
        double way = Aim(state, targets);
        _branches = 0;
        _isFresh = !BifurcationStep.HasTrail(state, _coordinates.AsSpan(0, _count));
        _newton.Limits.Begin(state);
        _good.CopyFrom(state);
        double s = 0;
        double step = way > LargestStep ? LargestStep / way : 1;
        int limit = -1;
        double leaptFrom = -1;
        bool crosses = way > 0 && (_isFresh ? Singular.Contains(state) : state.IsAtCrossing);
        double left = MaxSteps + StepsOfTheWay * way / LargestStep;
        while (s < 1)
        {
            cancellation.ThrowIfCancellationRequested();
            if (left-- <= 0)
            {
                return End(state, s, limit);
            }

            double next = s + step >= 1 ? 1 : s + step;
            bool leapt = false;
            if (crosses || !Track(state, next, s > 0 || !_isFresh))
            {
                state.CopyFrom(_good);
                step = crosses ? step : (next - s) / 2;
                bool leaps = crosses || (limit < 0 && step * way <= LeapStep && s > leaptFrom);
                crosses = false;
                leaptFrom = leaps ? s : leaptFrom;
                if (!leaps || !Cross(state, s, way, out next))
                {
                    if (step * way <= (limit >= 0 ? LeastStepAtLimit : LeastStep))
                    {
                        return End(state, s, limit);
                    }

                    continue;
                }

                leapt = true;
            }

            _newton.Limits.Measure(state);
            int broken = _newton.Limits.Worst(LimitTolerance);
            if (broken >= 0)
            {
                next = Contact(state, s, next, ref broken);
                limit = broken;
                _newton.Limits.IsActive[broken] = true;
            }

            state.IsAtCrossing = way > 0 ? next >= 1 && Arrives(state, s, way, leapt) : state.IsAtCrossing;

            s = next;
            Array.Copy(_good.Values, state.Trail, state.Trail.Length);
            _good.CopyFrom(state);
            step = Math.Min(step * 2, Math.Max(LargestStep / Math.Max(way, LargestStep), 1e-300));
        }

        return Result(DriveStatus.Reached, 1, limit);
    }

    /// <summary>The ways on from a state; allocates.</summary>
    /// <param name="state">Closed; not changed.</param>
    /// <param name="driven">Driven coordinates.</param>
    /// <param name="step">Their change along the first step, radians or metres.</param>
    public List<MotionBranch> Branches(MechanismState state, ReadOnlySpan<int> driven, ReadOnlySpan<double> step) =>
        (_search ??= new BranchSearch(_mechanism, _newton, Singular)).Find(state, driven, step);

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

    private bool Cross(MechanismState state, double s, double way, out double next) => s == 0 && _isFresh
        ? Leave(state, way, out next)
        : _leap.TryOver(state, _coordinates.AsSpan(0, _count), _from, _to, s, way, out next);

    // Off a pose that nothing was travelled to: branches are told apart some way off, and the one chosen is followed back to
    // where the drive ends if that is nearer.
    private bool Leave(MechanismState state, double way, out double next)
    {
        next = Math.Min(1, LeapStep / way);
        for (int i = 0; i < _count; i++)
        {
            _first[i] = LeapStep / way * (_to[i] - _from[i]);
        }

        List<MotionBranch> branches = Branches(state, _coordinates.AsSpan(0, _count), _first.AsSpan(0, _count));
        if (branches.Count == 0)
        {
            return false;
        }

        _branches = branches.Count;
        MechanismState branch = branches[0].State;
        if (way < LeapStep && _leap.TryAlong(state, branch, way / LeapStep, _coordinates.AsSpan(0, _count), _to))
        {
            return true;
        }

        state.CopyFrom(branch);
        return way >= LeapStep || Approach(state, LeapStep / way);
    }

    // Back to s = 1 from beyond it.
    private bool Approach(MechanismState state, double s)
    {
        double next = 1;
        for (int n = 0; n < MaxContactIterations && s > 1; n++)
        {
            _before.CopyFrom(state);
            _newton.ClearDriven();
            for (int i = 0; i < _count; i++)
            {
                _newton.Drive(_coordinates[i], next <= 1 ? _to[i] : _from[i] + next * (_to[i] - _from[i]));
            }

            if (_newton.Track(state))
            {
                s = next;
                next = 1;
            }
            else
            {
                state.CopyFrom(_before);
                next = (s + next) / 2;
            }
        }

        return s <= 1;
    }

    // Where branches cross, Newton's method alone would leave the pose, and with it the way on, to chance.
    private bool Arrives(MechanismState state, double s, double way, bool leapt)
    {
        if (!(leapt || _newton.MayBeSingular) || !Singular.Contains(state))
        {
            return false;
        }

        for (int i = 0; i < _count; i++)
        {
            _first[i] = (_to[i] - _from[i]) / way;
        }

        if (!_good.IsAtCrossing && !(s == 0 && _isFresh))
        {
            _crossing.Refine(state, _good, _coordinates.AsSpan(0, _count), _to, _first, (1 - s) * way);
        }

        return true;
    }

    private bool Track(MechanismState state, double s, bool acceptsDoubleRoot = true)
    {
        _newton.ClearDriven();
        for (int i = 0; i < _count; i++)
        {
            _newton.Drive(_coordinates[i], s >= 1 ? _to[i] : _from[i] + s * (_to[i] - _from[i]));
        }

        return _newton.Track(state, acceptsDoubleRoot);
    }

    // The s at which the first limit is met: false position with Illinois' halving between a pose inside and one outside.
    // Another limit may turn out to be met earlier; then that one is looked for.
    private double Contact(MechanismState state, double start, double outside, ref int limit)
    {
        LimitSet limits = _newton.Limits;
        double inside = start;
        double outer = limits.Distances[limit];
        limits.Measure(_good);
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

            limits.Measure(state);
            int broken = limits.Worst(LimitTolerance);
            if (broken >= 0 && broken != limit)
            {
                limit = broken;
                outer = limits.Distances[limit];
                limits.Measure(_good);
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
        new(status, s, _newton.Iterations, _newton.ErrorMetres, _newton.ErrorDegrees, _branches, limit < 0 ? null : LimitNames.Of(_good, _newton.Limits, limit));
}
