using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Runtime.ExceptionServices;
using System.Threading;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics.Rattle;
using Kinefab.Dynamics.Pgs;
using Kinefab.Json;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Dynamics;

/// <summary>
/// The bodies and joints of a scene in motion, as Unity makes them at start-up. There are no contacts: colliders are not
/// simulated. Bodies do not sleep. The same calls give the same bits; a step allocates nothing unless a joint breaks or there is something new to tell of it.
/// </summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed partial class World
{
    private readonly MultibodySystem _mechanism;
    private readonly ISolver _solver;
    private readonly bool[] _broken;
    private readonly ExactStepFindings _exact = new();
    private readonly WorldNames _names;
    private readonly JointUpkeep _upkeep;

    private World(ValidScene scene, SolverKind kind, MultibodySystem mechanism, ISolver solver, WorldBody[] bodies, WorldJoint[] joints, WorldNames names, Report findings)
    {
        Scene = scene;
        Solver = kind;
        _mechanism = mechanism;
        _solver = solver;
        _broken = new bool[joints.Length];
        _upkeep = new JointUpkeep(joints, kind == SolverKind.Exact ? 0.5 : 1);
        Bodies = bodies;
        Joints = joints;
        _names = names;
        Findings = findings;
        Action<Diagnostic> tell = TellOnce;
        Action<WorldJoint, Document.Joint> given = TellOfMassScales;
        foreach (WorldJoint joint in joints)
            (joint.Tell, joint.Given) = (tell, given);
    }

    /// <summary>Raised after a step for every joint that broke in it. What a handler throws, the step throws when all have been told.</summary>
    public event EventHandler<JointBrokenEventArgs>? JointBroken;

    /// <summary>The scene that it was made from.</summary>
    public ValidScene Scene { get; }

    /// <summary>How it moves.</summary>
    public SolverKind Solver { get; }

    /// <summary>In the order of their GameObjects.</summary>
    public IReadOnlyList<WorldBody> Bodies { get; }

    /// <summary>In the order of their GameObjects and components.</summary>
    public IReadOnlyList<WorldJoint> Joints { get; }

    /// <summary>
    /// What of the scene this world's solver does not follow; none is an error. Steps that the exact solver could not solve,
    /// and poses that it closed before a step, are added as they occur, each joint once, ten findings of a kind at most; and so is what a
    /// program asks of a joint that it cannot have: each joint once.
    /// </summary>
    public Report Findings { get; private set; }

    /// <summary>Seconds simulated.</summary>
    public double Time { get; private set; }

    /// <summary>m/s^2.</summary>
    /// <exception cref="ArgumentOutOfRangeException">A component is no number.</exception>
    public Vector3d Gravity
    {
        get => _mechanism.Gravity;
        set => _mechanism.Gravity = value.FiniteOrThrow(nameof(value));
    }

    /// <summary>
    /// How many threads a step may use, the caller's among them; 1 unless it is set. Mechanisms that do not hang together are shared out
    /// among them; the result has the same bits with any number. It pays from some hundred joints on, in some dozens of mechanisms. The
    /// others are background threads of the process, made when first needed; of several worlds that step at once, one has them. In unity,
    /// scenes with couplings or ArticulationBodies are stepped by one thread.
    /// </summary>
    /// <exception cref="ArgumentOutOfRangeException">It is less than 1.</exception>
    public int Threads
    {
        get => _mechanism.Threads;
        set => _mechanism.Threads = value >= 1 ? value : throw new ArgumentOutOfRangeException(nameof(value), "At least 1.");
    }

    /// <summary>
    /// Number of times that motion was stopped where it stood: a body's that left the range of numbers, or a mechanism's in a
    /// part of a step that the exact solver could not solve (see <see cref="Findings"/>). 0 unless the solver cannot follow
    /// the scene.
    /// </summary>
    public int Stops => _mechanism.Stops;

    /// <inheritdoc cref="MultibodySystem.SubstepWork"/>
    internal double SubstepWork => _mechanism.SubstepWork;

    /// <summary>Kinetic energy of all bodies, J.</summary>
    public double KineticEnergy
    {
        get
        {
            double energy = 0;
            for (int i = 0; i < _mechanism.Bodies.Count; i++)
            {
                energy += _mechanism.Bodies.KineticEnergy(i);
            }

            return energy;
        }
    }

    /// <summary>Energy of all bodies under gravity, J, 0 at the world's origin.</summary>
    public double PotentialEnergy
    {
        get
        {
            double energy = 0;
            for (int i = 0; i < _mechanism.Bodies.Count; i++)
            {
                energy += _mechanism.Bodies.PotentialEnergy(i, _mechanism.Gravity);
            }

            return energy;
        }
    }

    /// <summary>The bodies, joints and couplings of a scene file at its start pose. Inactive objects are left out.</summary>
    /// <param name="path">A scene file, NAME.kinefab.</param>
    /// <param name="solver">As Unity moves it, or as it truly moves.</param>
    /// <param name="options">Null: unknown fields are warnings, limits the default ones.</param>
    /// <param name="cancellation">Ends the reading, or the making, early.</param>
    /// <returns>A world at rest unless the scene says otherwise; warnings stand in its scene's <see cref="ValidScene.Report"/>.</returns>
    /// <exception cref="SceneFormatException">The file has errors; the exception holds the report.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    /// <example><code>
    /// World world = World.Load("lever.kinefab", SolverKind.Exact);
    /// world.DriveAt("Shaft", 60);
    /// RunResult run = world.Run(seconds: 6, record: new[] { "Shaft", "Slide" });
    /// </code></example>
    public static World Load(string path, SolverKind solver = SolverKind.Unity, SceneReadOptions? options = null, CancellationToken cancellation = default) =>
        Create(ValidScene.Load(path, options, cancellation), solver, cancellation);

    /// <summary>The bodies, joints and couplings of a scene at its start pose. Inactive objects are left out.</summary>
    /// <param name="scene">A valid one.</param>
    /// <param name="solver">As Unity moves it, or as it truly moves.</param>
    /// <param name="cancellation">Ends the making early: of wide grids of closed cells it takes seconds.</param>
    /// <returns>At time zero, nothing moved yet.</returns>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public static World Create(ValidScene scene, SolverKind solver = SolverKind.Unity, CancellationToken cancellation = default)
    {
        if (scene is null)
        {
            throw new ArgumentNullException(nameof(scene));
        }

        var builder = new WorldBuilder(scene, locksAsJoints: solver == SolverKind.Exact);
        List<Island> islands = IslandFinder.Find(builder.MultibodySystem);
        List<InconsistentLoop> loops = LoopConsistencyProbe.Find(builder.MultibodySystem, islands, cancellation);
        builder.MultibodySystem.Cancellation = cancellation;
        ISolver chosen = solver switch
        {
            SolverKind.Unity => new PgsSolver(builder.MultibodySystem, builder.Articulated),
            SolverKind.Exact => new RattleSolver(builder.MultibodySystem, loops, probed: islands),
            _ => throw new ArgumentOutOfRangeException(nameof(solver)),
        };
        builder.MultibodySystem.Cancellation = default;
        List<Diagnostic> findings = solver == SolverKind.Exact ? ExactSolverCheck.Of(scene) : new List<Diagnostic>();
        findings.AddRange(InexactLoopCheck.Of(loops, builder.Joints));
        var names = new WorldNames(scene.Document.GameObjects, builder.Bodies, builder.Joints);
        return new World(scene, solver, builder.MultibodySystem, chosen, builder.Bodies, builder.Joints, names, new Report(findings));
    }

    /// <summary>The body of the GameObject with an id, or with a name that no other has.</summary>
    /// <param name="idOrName">Such as Lever/Crank:1.</param>
    /// <returns>The body as it moves: reading it later gives what is then true.</returns>
    /// <exception cref="ArgumentException">There is no such body; the message says which there are.</exception>
    public WorldBody Body(string idOrName) => _names.Body(idOrName ?? throw new ArgumentNullException(nameof(idOrName)));

    /// <summary>
    /// The joint that the source calls so (Shaft), or that stands for a constraint that it calls so; else the one whose GameObject has the
    /// id or name, with [COMPONENT] behind it where that carries several. A <see cref="WorldJoint.Name"/> always finds its own.
    /// </summary>
    /// <param name="name">Such as Shaft, Lever/Crank:1, or Arm:2[3] for the fourth component of Arm:2.</param>
    /// <returns>The joint as it moves; reading it later gives what is then true.</returns>
    /// <exception cref="ArgumentException">None answers to it, or several do; the message says which there are.</exception>
    public WorldJoint Joint(string name) => _names.Joint(name ?? throw new ArgumentNullException(nameof(name)));

    /// <summary>A joint coordinate by its name: degrees (over any number of turns) or metres, zero at the start.</summary>
    /// <param name="name">Such as Shaft, Slide.x or Lever/Crank:1.angle: the source's name for the joint, else its GameObject's id or name, and the coordinate
    /// behind it where there are several.</param>
    /// <exception cref="ArgumentException">None answers to the name, or several do: the message says which there are.</exception>
    public double this[string name]
    {
        get
        {
            (WorldJoint joint, Coordinate coordinate) = Named(name);
            return joint.Coordinate(coordinate);
        }
    }

    /// <summary>Drives a joint coordinate towards a value, see <see cref="WorldJoint.DriveTo"/>; drives of other coordinates stay, but for those of a slerp drive.</summary>
    /// <param name="name">As in <see cref="this[string]"/>.</param>
    /// <param name="target">Degrees or metres.</param>
    /// <exception cref="ArgumentException">None answers to the name, or several do (the message says which there are); or the target is no finite number.</exception>
    public void DriveTo(string name, double target)
    {
        (WorldJoint joint, Coordinate coordinate) = Named(name);
        joint.DriveTo(coordinate, target);
    }

    /// <summary>Drives a joint coordinate at a speed, see <see cref="WorldJoint.DriveAt"/>; drives of other coordinates stay, but for those of a slerp drive.</summary>
    /// <param name="name">As in <see cref="this[string]"/>.</param>
    /// <param name="speed">Degrees/s or metres/s.</param>
    /// <exception cref="ArgumentException">None answers to the name, or several do (the message says which there are); or the speed is no finite number.</exception>
    public void DriveAt(string name, double speed)
    {
        (WorldJoint joint, Coordinate coordinate) = Named(name);
        joint.DriveAt(coordinate, speed);
    }

    /// <summary>Moves the world forward by one step; <see cref="Run"/> makes many.</summary>
    /// <param name="dt">Seconds; Unity's fixed time step is in the scene's physics settings.</param>
    /// <param name="cancellation">
    /// Ends the step early; the world then is as it was before the call, and the same calls give the same bits. A step that can be ended so
    /// takes down the state first, as <see cref="Snapshot"/> does: it pays where a step may take long, as of grids of a thousand closed cells.
    /// </param>
    /// <exception cref="ArgumentOutOfRangeException">dt is not a positive number.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public void Step(double dt, CancellationToken cancellation = default)
    {
        if (!(dt > 0 && dt < double.PositiveInfinity))
        {
            throw new ArgumentOutOfRangeException(nameof(dt), "Not a positive finite number of seconds.");
        }

        cancellation.ThrowIfCancellationRequested();
        WorldSnapshot? before = cancellation.CanBeCanceled ? Snapshot() : null;
        _mechanism.Cancellation = cancellation;
        try
        {
            Advance(dt);
        }
        catch (OperationCanceledException) when (before != null)
        {
            // Coming back is not to be ended.
            _mechanism.Cancellation = default;
            Restore(before);
            throw;
        }
        finally
        {
            _mechanism.Cancellation = default;
        }

        ExceptionDispatchInfo? failure = null;
        for (int i = 0; i < Joints.Count; i++)
        {
            WorldJoint joint = Joints[i];
            if (joint.IsBroken && !_broken[i])
            {
                _broken[i] = true;
                TellBroken(joint, ref failure);
            }
        }

        failure?.Throw();
    }

    /// <summary>Solver, time, and how many bodies and joints there are.</summary>
    public override string ToString() =>
        FormattableString.Invariant($"{Solver} world at {Time:0.######} s: {Invariant.Counted(Bodies.Count, "body", "bodies")}, {Invariant.Counted(Joints.Count, "joint")}{(Stops > 0 ? ", " + Invariant.Counted(Stops, "stop") : "")}");

    private void TellOnce(Diagnostic found)
    {
        foreach (Diagnostic said in Findings.Diagnostics)
        {
            if (said.Code == found.Code && said.Pointer == found.Pointer)
                return;
        }

        Findings = Findings.Concat(new Report(new[] { found }));
    }

    // As ExactSolverCheck does of those that the scene has.
    private void TellOfMassScales(WorldJoint joint, Document.Joint settings)
    {
        if (Solver == SolverKind.Exact && ExactSolverCheck.HasMassScales(settings))
            TellOnce(Diagnostic.Of(DiagnosticCodes.MassScaleIgnored, joint.Pointer, ExactSolverCheck.MassScales(settings)));
    }

    // Each handler by itself: one that throws keeps nothing from the others.
    private void TellBroken(WorldJoint joint, ref ExceptionDispatchInfo? failure)
    {
        if (JointBroken is not { } handlers)
            return;
        var told = new JointBrokenEventArgs(joint);
        foreach (Delegate handler in handlers.GetInvocationList())
        {
            try
            {
                ((EventHandler<JointBrokenEventArgs>)handler)(this, told);
            }
            catch (Exception thrown)
            {
                failure ??= ExceptionDispatchInfo.Capture(thrown);
            }
        }
    }

    private void Advance(double dt)
    {
        // A broken joint is in no island any more, so that nobody writes its reaction.
        for (int i = 0; i < _broken.Length; i++)
        {
            if (_broken[i])
            {
                _mechanism.ClearReaction(i);
            }
        }

        if (_mechanism.HasChangedSpeeds)
        {
            _mechanism.HasChangedSpeeds = false;
            foreach (WorldJoint joint in Joints)
                joint.NoteSpeeds();
        }

        _upkeep.BeforeStep(Threads);
        _solver.Step(dt);
        if (_mechanism.Unsolved.Count > 0 || _mechanism.Closed.Count > 0 || _mechanism.ForbiddenSpeeds.Count > 0 || _mechanism.HeldLimits.Count > 0 || _mechanism.StalledJoints.Count > 0)
        {
            List<Diagnostic> found = _exact.Of(_mechanism, Bodies, Joints, Time);
            Findings = found.Count > 0 ? Findings.Concat(new Report(found)) : Findings;
        }

        Time += dt;
        _upkeep.AfterStep(dt, Threads);
    }

    private (WorldJoint Joint, Coordinate Coordinate) Named(string name) => _names.Coordinate(name ?? throw new ArgumentNullException(nameof(name)));
}
