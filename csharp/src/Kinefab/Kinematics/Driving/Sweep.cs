using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>Takes a coordinate through a range, or finds how far it goes.</summary>
public sealed class Sweep
{
    private const double FarthestAngle = 360;

    // Poses that differ by more than this after the way back, radians or lengths, are another branch.
    private const double JumpTolerance = 0.02;

    private readonly Mechanism _mechanism;
    private readonly PositionSolver _solver;
    private readonly DeadPointSearch _deadPoints;
    private readonly MechanismState _back;

    /// <summary>Sweeps with a solver of the caller's.</summary>
    /// <param name="solver">Of the mechanism whose states are swept.</param>
    public Sweep(PositionSolver solver)
    {
        _solver = solver ?? throw new ArgumentNullException(nameof(solver));
        _mechanism = solver.Mechanism;
        _deadPoints = new DeadPointSearch(_mechanism, solver.Newton, solver.Singular);
        _back = _mechanism.NewState();
    }

    /// <summary>
    /// Drives a coordinate from one value to another in equal steps and keeps every state. Where it is stopped, the last
    /// state is the one at the stop, whose place is found to rounding.
    /// </summary>
    /// <param name="state">Where to start; left at the last state.</param>
    /// <param name="coordinate">Index into the mechanism's coordinates.</param>
    /// <param name="from">Degrees or metres; driven to first.</param>
    /// <param name="to">Degrees or metres.</param>
    /// <param name="steps">At least 1; one state more is kept.</param>
    /// <param name="progress">Told the number of steps done after each; null: nobody is.</param>
    /// <param name="cancellation">Ends the sweep early; the state then stands somewhere on the way.</param>
    /// <returns>A state for each value reached; where the motion ended early, why.</returns>
    /// <exception cref="ArgumentException">The state is another mechanism's, or there is no such coordinate.</exception>
    /// <exception cref="ArgumentOutOfRangeException">A value is no finite number, or farther than <see cref="MechanismCoordinate.Farthest"/> from where the
    /// state stands, or there is not even 1 step.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public SweepResult Run(MechanismState state, int coordinate, double from, double to, int steps, IProgress<int>? progress = null, CancellationToken cancellation = default)
    {
        if (state is null)
            throw new ArgumentNullException(nameof(state));
        _solver.Check(coordinate, nameof(coordinate));
        _mechanism.Coordinates[coordinate].Demand(from, state.Coordinate(coordinate), nameof(from));
        _mechanism.Coordinates[coordinate].Demand(to, state.Coordinate(coordinate), nameof(to));
        if (steps < 1)
            throw new ArgumentOutOfRangeException(nameof(steps), "At least 1.");
        var values = new List<double>(steps + 1);
        var states = new List<MechanismState>(steps + 1);
        var jumps = new List<double>();
        double metres = 0;
        double degrees = 0;
        RangeLimit? stop = null;
        IReadOnlyList<MotionBranch> branches = Array.Empty<MotionBranch>();
        MechanismState last = state.Clone();
        for (int i = 0; i <= steps && stop is null; i++)
        {
            double target = i == steps ? to : from + (to - from) * i / steps;
            double before = last.Coordinate(coordinate);
            DriveResult result = _solver.Drive(state, coordinate, target, cancellation);
            metres = Math.Max(metres, result.ErrorMetres);
            degrees = Math.Max(degrees, result.ErrorDegrees);
            if (!result.Converged)
            {
                stop = StopOf(state, coordinate, target - before, result);
            }

            if (result.Branches > 0 && branches.Count == 0)
            {
                branches = _solver.Branches(last, coordinate, target > before, cancellation);
            }

            if (i > 0 && !Returns(state, last, coordinate, cancellation))
            {
                jumps.Add(state.Coordinate(coordinate));
            }

            values.Add(state.Coordinate(coordinate));
            states.Add(last = state.Clone());
            progress?.Report(i);
        }

        return new SweepResult(coordinate, values, states, jumps, branches, stop, metres, degrees);
    }

    /// <summary>
    /// How far a coordinate goes from a state: up to a whole turn or a hundred lengths of the mechanism each way.
    /// </summary>
    /// <param name="state">Not changed.</param>
    /// <param name="coordinate">Index into the mechanism's coordinates.</param>
    /// <param name="cancellation">Ends the search early.</param>
    /// <returns>The lowest and the highest value, degrees or metres, each with what ends the motion there.</returns>
    /// <exception cref="ArgumentException">The state is another mechanism's, or there is no such coordinate.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public (RangeLimit Low, RangeLimit High) Range(MechanismState state, int coordinate, CancellationToken cancellation = default) =>
        (End(state, coordinate, -1, cancellation), End(state, coordinate, 1, cancellation));

    private RangeLimit End(MechanismState state, int coordinate, double direction, CancellationToken cancellation)
    {
        if (state is null)
            throw new ArgumentNullException(nameof(state));
        _solver.Check(coordinate, nameof(coordinate));
        MechanismState moved = state.Clone();
        double far = _mechanism.Coordinates[coordinate].IsAngle ? FarthestAngle : 100 * _mechanism.Length;
        DriveResult result = _solver.Follow(moved, coordinate, state.Coordinate(coordinate) + direction * far, cancellation);
        return result.Converged
            ? new RangeLimit(RangeEnd.Open, moved.Coordinate(coordinate), null)
            : StopOf(moved, coordinate, direction, result);
    }

    private RangeLimit StopOf(MechanismState state, int coordinate, double direction, DriveResult result)
    {
        double value = state.Coordinate(coordinate);
        if (result.Status == DriveStatus.StoppedByLimit)
        {
            return new RangeLimit(RangeEnd.Limit, value, result.Limit);
        }

        if (result.Status == DriveStatus.OutOfReach && _deadPoints.Find(state, coordinate, Math.Sign(direction)) is DeadPoint dead)
        {
            return new RangeLimit(dead.Kind == DeadPointKind.Fold ? RangeEnd.Fold : RangeEnd.Bifurcation, dead.Value, null);
        }

        return new RangeLimit(RangeEnd.Unknown, value, null);
    }

    private bool Returns(MechanismState state, MechanismState before, int coordinate, CancellationToken cancellation)
    {
        _back.CopyFrom(state);
        _solver.Follow(_back, coordinate, before.Coordinate(coordinate), cancellation);

        // A way back that ends just short of a dead centre is a way back.
        // Poses, not coordinates: single angles of a joint that turns freely about several axes lose their meaning at a half turn.
        for (int i = 0; i < _back.Poses.Length; i++)
        {
            Vector3d shift = _back.Poses[i].Position - before.Poses[i].Position;
            Vector3d turn = 2 * (_back.Poses[i].Rotation * before.Poses[i].Rotation.Conjugate()).Vector;
            if (shift.Length > JumpTolerance * _mechanism.Length || turn.Length > JumpTolerance)
            {
                return false;
            }
        }

        return true;
    }
}
