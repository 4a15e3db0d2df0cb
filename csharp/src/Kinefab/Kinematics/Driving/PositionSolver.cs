using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Kinefab.Mechanisms;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Moves a mechanism at position level: drives coordinates, drags points, closes gaps. Holds the working memory of one
/// thread; after its first calls it allocates nothing. The same state and targets give the same bits.
/// </summary>
public sealed class PositionSolver
{
    private readonly CoordinateDrive _drive;
    private readonly NewtonSolver _newton;
    private readonly Dictionary<int, PointDrag> _drags = new();

    /// <summary>A solver for a mechanism.</summary>
    /// <param name="mechanism">Whose states it moves; one solver serves one thread.</param>
    /// <param name="cancellation">Ends the making early: of wide grids of closed cells it takes seconds.</param>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public PositionSolver(Mechanism mechanism, CancellationToken cancellation = default)
    {
        Mechanism = mechanism ?? throw new ArgumentNullException(nameof(mechanism));
        _newton = new NewtonSolver(mechanism.Linkage, cancellation);
        _drive = new CoordinateDrive(mechanism, _newton);
        MechanismState start = mechanism.NewState();
        _newton.Close(start);
        StartError = Math.Max(_newton.Equations.Worst, _newton.Motion.WorstError);
        // An exported scene may not close better than its numbers were written; the misfit moves with the pose.
        _newton.Accepted = Math.Max(_newton.Accepted, 4 * StartError);
    }

    /// <summary>What it solves.</summary>
    public Mechanism Mechanism { get; }

    /// <summary>Misfit that is left when the exported pose is closed as well as can be, lengths of the mechanism or radians.</summary>
    internal double StartError { get; }

    internal NewtonSolver Newton => _newton;

    internal RankDeficiency Singular => _drive.Singular;

    /// <summary>
    /// Moves coordinates to values, all together along straight lines, in steps small enough to stay on the branch, and
    /// everything else by as little as can be. Stops at the first limit that cannot be dodged and at the last closed pose
    /// before a dead point.
    /// </summary>
    /// <param name="state">Where to start from; moved.</param>
    /// <param name="targets">Each coordinate at most once.</param>
    /// <param name="cancellation">Ends the drive early; the state then stands somewhere on the way.</param>
    /// <returns>How far it came and what stopped it: limits and dead points are results, not errors.</returns>
    /// <exception cref="ArgumentException">The state is another mechanism's, or a target names no coordinate, or a coordinate twice; the message says which
    /// coordinates there are.</exception>
    /// <exception cref="ArgumentOutOfRangeException">A target is no finite number, or farther than <see cref="MechanismCoordinate.Farthest"/> from where the
    /// state stands.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public DriveResult Drive(MechanismState state, ReadOnlySpan<CoordinateTarget> targets, CancellationToken cancellation = default)
    {
        Begin(state, cancellation);
        for (int i = 0; i < targets.Length; i++)
        {
            Check(targets[i].Coordinate, nameof(targets));
            Mechanism.Coordinates[targets[i].Coordinate].Demand(targets[i].Value, state.Coordinate(targets[i].Coordinate), nameof(targets));
            for (int k = 0; k < i; k++)
            {
                if (targets[k].Coordinate == targets[i].Coordinate)
                    throw new ArgumentException($"{Mechanism.Coordinates[targets[i].Coordinate].Name} is driven twice.", nameof(targets));
            }
        }

        return _drive.Run(state, targets, cancellation);
    }

    /// <summary>Moves one coordinate to a value, degrees or metres from the exported pose.</summary>
    /// <param name="state">Where to start from; moved.</param>
    /// <param name="coordinate">Index into the mechanism's coordinates.</param>
    /// <param name="value">Degrees or metres.</param>
    /// <param name="cancellation">Ends the drive early; the state then stands somewhere on the way.</param>
    /// <returns>How far it came and what stopped it: limits and dead points are results, not errors.</returns>
    /// <exception cref="ArgumentException">The state is another mechanism's, or there is no such coordinate.</exception>
    /// <exception cref="ArgumentOutOfRangeException">The value is no finite number, or farther than <see cref="MechanismCoordinate.Farthest"/> from where the
    /// state stands.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public DriveResult Drive(MechanismState state, int coordinate, double value, CancellationToken cancellation = default)
    {
        Begin(state, cancellation);
        Check(coordinate, nameof(coordinate));
        Mechanism.Coordinates[coordinate].Demand(value, state.Coordinate(coordinate), nameof(value));
        return Follow(state, coordinate, value, cancellation);
    }

    /// <summary>Moves one coordinate to a value, degrees or metres from the exported pose.</summary>
    /// <param name="state">Where to start from; moved.</param>
    /// <param name="coordinate">Such as Shaft or Lever/Crank:1.angle, see <see cref="Mechanism.TryFindCoordinate"/>.</param>
    /// <param name="value">Degrees or metres.</param>
    /// <param name="cancellation">Ends the drive early; the state then stands somewhere on the way.</param>
    /// <returns>How far it came and what stopped it: limits and dead points are results, not errors.</returns>
    /// <exception cref="ArgumentException">None answers to the name, or several do: the message says which there are.</exception>
    /// <exception cref="ArgumentOutOfRangeException">The value is no finite number, or farther than <see cref="MechanismCoordinate.Farthest"/> from where the
    /// state stands.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    /// <example><code>
    /// var solver = new PositionSolver(mechanism);
    /// MechanismState state = mechanism.NewState();
    /// DriveResult result = solver.Drive(state, "Shaft", 90);
    /// Console.WriteLine($"{result}: {state["Slide"]} m");
    /// </code></example>
    public DriveResult Drive(MechanismState state, string coordinate, double value, CancellationToken cancellation = default) =>
        Drive(state, Mechanism.CoordinateNamed(coordinate), value, cancellation);

    /// <summary>
    /// The ways that lead on from a pose when a coordinate is driven. One at most poses, none at a dead centre; several
    /// where branches of motion meet, as in a parallelogram that lies flat. The straightest stands first, it is the one that
    /// <see cref="Drive(MechanismState, int, double, CancellationToken)"/> takes; copy the state of another one to take that.
    /// Limits are not looked at. Allocates.
    /// </summary>
    /// <param name="state">Closed; not changed.</param>
    /// <param name="coordinate">Index into the mechanism's coordinates.</param>
    /// <param name="isRising">Driven upwards, or downwards.</param>
    /// <param name="cancellation">Ends the search early.</param>
    /// <returns>One entry a way, each with the rates of all coordinates against the driven one; empty at a dead centre.</returns>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public IReadOnlyList<MotionBranch> Branches(MechanismState state, int coordinate, bool isRising = true, CancellationToken cancellation = default)
    {
        Begin(state, cancellation);
        Check(coordinate, nameof(coordinate));
        double unit = Mechanism.Coordinates[coordinate].IsAngle ? 1 : Mechanism.Length;
        ReadOnlySpan<double> step = stackalloc double[] { (isRising ? 1 : -1) * CoordinateDrive.LeapStep * unit };
        return _drive.Branches(state, stackalloc int[] { coordinate }, step);
    }

    /// <summary>
    /// Pulls a point of a body towards a place in the world as far as joints and limits let it, sliding along the limits.
    /// The first call for a body allocates.
    /// </summary>
    /// <param name="state">Where to start from; moved.</param>
    /// <param name="gameObject">A GameObject that a Rigidbody moves.</param>
    /// <param name="point">In the GameObject's own unscaled frame, metres.</param>
    /// <param name="target">World, metres.</param>
    /// <param name="cancellation">Ends the pull early; the state then stands somewhere on the way.</param>
    /// <returns>Where it rests: a limit or the end of its reach is a result, not an error.</returns>
    /// <exception cref="ArgumentException">The state is another mechanism's, no Rigidbody moves the GameObject, there is none, or a number is not finite.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    /// <example><code>
    /// solver.Drag(state, "SliderD:1", point: Vector3d.Zero, target: new Vector3d(-0.1, 0.02, 0));
    /// </code></example>
    public DriveResult Drag(MechanismState state, int gameObject, Vector3d point, Vector3d target, CancellationToken cancellation = default)
    {
        Begin(state, cancellation);
        if (!point.IsFinite || !target.IsFinite)
            throw new ArgumentException("The point or the target is not finite.", nameof(target));
        int body = Mechanism.BodyOf(gameObject);
        if (body < 0)
            throw new ArgumentException("No Rigidbody moves this GameObject.", nameof(gameObject));
        if (!_drags.TryGetValue(body, out PointDrag? drag))
        {
            drag = new PointDrag(Mechanism, _newton, body);
            _drags.Add(body, drag);
        }

        DriveResult result = drag.Run(state, Mechanism.PointInBody(gameObject, point), target);
        state.ForgetTrail();
        return result;
    }

    /// <summary>Pulls a point of a body, named by its GameObject's id or name, towards a place in the world.</summary>
    /// <param name="state">Where to start from; moved.</param>
    /// <param name="gameObject">Id, or a name that no other has, of a GameObject that a Rigidbody moves.</param>
    /// <param name="point">In the GameObject's own unscaled frame, metres.</param>
    /// <param name="target">World, metres.</param>
    /// <param name="cancellation">Ends the pull early; the state then stands somewhere on the way.</param>
    /// <returns>How near the point came, and what ended the pull.</returns>
    /// <exception cref="ArgumentException">As for the other one; or none has the id or name, or several have the name: the message says which there are.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public DriveResult Drag(MechanismState state, string gameObject, Vector3d point, Vector3d target, CancellationToken cancellation = default) =>
        Drag(state, Mechanism.GameObjectNamed(gameObject), point, target, cancellation);

    /// <summary>Closes all joints and couplings from wherever the state stands, moving the joints little; limits are not looked at.</summary>
    /// <param name="state">Where to start from; moved.</param>
    /// <param name="cancellation">Ends the closing early; the state then stands somewhere on the way.</param>
    /// <returns>The gap that is left, and whether it is within tolerance.</returns>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public DriveResult Close(MechanismState state, CancellationToken cancellation = default)
    {
        Begin(state, cancellation);
        _newton.Iterations = 0;
        _newton.ClearDriven();
        _newton.Limits.Begin(state);
        bool closed = _newton.Close(state);
        state.ForgetTrail();
        DriveStatus status = closed ? DriveStatus.Reached : DriveStatus.NotClosed;
        return new DriveResult(status, closed ? 1 : 0, _newton.Iterations, _newton.ErrorMetres, _newton.ErrorDegrees, 0, null);
    }

    /// <summary>As <see cref="Drive(MechanismState, int, double, CancellationToken)"/>, of a value that is known to be within reach of the state's.</summary>
    internal DriveResult Follow(MechanismState state, int coordinate, double value, CancellationToken cancellation)
    {
        Begin(state, cancellation);
        return _drive.Run(state, stackalloc CoordinateTarget[] { new CoordinateTarget(coordinate, value) }, cancellation);
    }

    internal void Check(int coordinate, string argument)
    {
        if ((uint)coordinate >= (uint)Mechanism.Coordinates.Count)
            throw new ArgumentOutOfRangeException(argument, $"There is no coordinate {coordinate}; {SceneNames.There(Mechanism.Coordinates.Select((c, i) => $"{i} {c.Name}").ToArray())}");
    }

    private void Begin(MechanismState state, CancellationToken cancellation)
    {
        _newton.Cancellation = cancellation;
        if (state is null)
            throw new ArgumentNullException(nameof(state));
        if (!ReferenceEquals(state.Mechanism, Mechanism))
            throw new ArgumentException("The state belongs to another mechanism.", nameof(state));
    }
}
