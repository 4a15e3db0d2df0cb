using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Threading;
using Kinefab.Advice;
using Kinefab.Collisions;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Mechanisms;
using Kinefab.Numerics;
using Kinefab.Tests.Dynamics.Rattle;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Packaging;

/// <summary>
/// What reads, counts, is made from a scene to be solved, moves along a way, steps or runs can be ended early, whatever scene it is given. A step that
/// is leaves the world as it was: half of one is no state of a world.
/// </summary>
public sealed class CancellationTests
{
    // What such calls give back.
    private static readonly HashSet<Type> Results = new()
    {
        typeof(SceneReading), typeof(SceneValidation), typeof(ValidScene), typeof(MobilityReport), typeof(SweepResult), typeof(RunResult), typeof(AdviceReport),
        typeof((RangeLimit, RangeLimit)), typeof(DriveResult), typeof(IReadOnlyList<MotionBranch>), typeof(World),
    };

    // Objects that take long to make.
    private static readonly Type[] Makings = { typeof(PositionSolver) };

    [Test]
    public void PublicCalls_ThatMayTakeLong_CanBeCancelled()
    {
        MethodInfo[] calls = typeof(World).Assembly.GetExportedTypes()
            .SelectMany(type => type.GetMethods(BindingFlags.Public | BindingFlags.Instance | BindingFlags.Static | BindingFlags.DeclaredOnly))
            .Where(method => !method.IsSpecialName && Results.Contains(method.ReturnType))
            .ToArray();
        Assert.That(calls.Select(call => call.ReturnType).Distinct(), Is.EquivalentTo(Results));
        IEnumerable<MethodBase> all = calls.Append(typeof(World).GetMethod(nameof(World.Step))!).Concat<MethodBase>(Makings.SelectMany(type => type.GetConstructors()));
        Assert.That(all.Where(call => call.GetParameters().All(p => p.ParameterType != typeof(CancellationToken))).Select(call => $"{call.DeclaringType}.{call}"), Is.Empty);
    }

    [Test]
    public void EachPublicCallWithAToken_OnAWideGrid_EndsWhenCancelled()
    {
        SceneDocument document = HubScenes.Grid(20);
        using var written = new MemoryStream();
        SceneFile.Save(document, written);
        byte[] bytes = written.ToArray();
        string path = Path.Combine(TestContext.CurrentContext.WorkDirectory, "cancelled.kinefab");
        File.WriteAllBytes(path, bytes);
        ValidScene scene = ValidScene.Load(bytes);
        Mechanism mechanism = Mechanism.Create(scene);
        var solver = new PositionSolver(mechanism);
        var sweep = new Sweep(solver);
        World world = World.Create(scene, SolverKind.Unity);
        World exact = World.Create(scene, SolverKind.Exact);
        string first = mechanism.Coordinates[0].Name;
        int last = document.GameObjects.Count - 1;
        string lastId = document.GameObjects[last].Id;
        var far = new Vector3d(30, -40, 0);

        // By the name that the call has, once for each of its overloads.
        var calls = new (string Name, Action<CancellationToken> Call)[]
        {
            ("SceneFile.Load", token => SceneFile.Load(path, null, token)),
            ("SceneFile.Load", token => SceneFile.Load(new MemoryStream(bytes), ".", null, token)),
            ("SceneFile.Load", token => SceneFile.Load(new MemoryStream(bytes), (Func<string, ReadOnlyMemory<byte>?>)(_ => null), null, token)),
            ("SceneFile.Parse", token => SceneFile.Parse(bytes, null, null, token)),
            ("SceneFile.Parse", token => SceneFile.Parse(bytes.AsSpan(), null, null, token)),
            ("SceneValidator.Validate", token => SceneValidator.Validate(document, null, token)),
            ("ValidScene.Load", token => ValidScene.Load(path, null, token)),
            ("ValidScene.Load", token => ValidScene.Load(new MemoryStream(bytes), null, null, token)),
            ("ValidScene.Load", token => ValidScene.Load(bytes, null, null, token)),
            ("StartOverlaps.Of", token => StartOverlaps.Of(Boxes(), token)),
            ("ArticulatedScene.Of", token => ArticulatedScene.Of(scene, out _, token)),
            ("StabilityAdvice.Of", token => StabilityAdvice.Of(scene, null, token)),
            ("Mechanism.Load", token => Mechanism.Load(path, null, token)),
            ("Mechanism.CountMobility", token => mechanism.CountMobility(null, token)),
            ("MobilityAnalysis.Of", token => MobilityAnalysis.Of(mechanism, null, token)),
            ("Mechanism.ChooseFreedoms", token => mechanism.ChooseFreedoms(token)),
            ("Mechanism.Sweep", token => mechanism.Sweep(first, 0, 1, 10, null, token)),
            ("Sweep.Run", token => sweep.Run(mechanism.NewState(), 0, 0, 1, 10, null, token)),
            ("Sweep.Range", token => sweep.Range(mechanism.NewState(), 0, token)),
            ("PositionSolver..ctor", token => _ = new PositionSolver(mechanism, token)),
            ("PositionSolver.Close", token => solver.Close(Open(mechanism), token)),
            ("PositionSolver.Drag", token => solver.Drag(mechanism.NewState(), last, Vector3d.Zero, far, token)),
            ("PositionSolver.Drag", token => solver.Drag(mechanism.NewState(), lastId, Vector3d.Zero, far, token)),
            ("PositionSolver.Drive", token => solver.Drive(mechanism.NewState(), 0, 1, token)),
            ("PositionSolver.Drive", token => solver.Drive(mechanism.NewState(), first, 1, token)),
            ("PositionSolver.Drive", token => solver.Drive(mechanism.NewState(), new[] { new CoordinateTarget(0, 1) }, token)),
            ("PositionSolver.Branches", token => solver.Branches(mechanism.NewState(), 0, true, token)),
            ("World.Load", token => World.Load(path, SolverKind.Unity, null, token)),
            ("World.Create", token => World.Create(scene, SolverKind.Unity, token)),
            ("World.Step", token => world.Step(0.02, token)),
            ("World.Run", token => world.Run(1, null, null, null, null, token)),
        };
        Assert.That(calls.Select(call => call.Name), Is.EquivalentTo(WithToken()));
        var ofTheOtherSolver = new (string, Action<CancellationToken>)[]
        {
            ("World.Create exact", token => World.Create(scene, SolverKind.Exact, token)),
            ("World.Step exact", token => exact.Step(0.02, token)),
        };
        foreach ((string name, Action<CancellationToken> call) in calls.Concat(ofTheOtherSolver))
        {
            Assert.That(() => call(new CancellationToken(true)), Throws.InstanceOf<OperationCanceledException>(), name);
        }

        // What was ended leaves nothing behind.
        Assert.That(solver.Close(Open(mechanism)).Converged, Is.True);
    }

    [Test]
    public void Step_CancelledAnywhere_LeavesTheWorldAsItWas([Values] SolverKind solver, [Values("star", "pair", "comb", "grid")] string kind)
    {
        ValidScene scene = SceneValidator.Validate(HubScenes.Kinds[kind](300)).Scene!;
        World plain = World.Create(scene, solver);
        World cancelled = World.Create(scene, solver);
        cancelled.Threads = 2;
        for (int step = 0; step < 20; step++)
        {
            ulong before = cancelled.StateHash();
            double time = cancelled.Time;
            for (int attempt = 0; attempt < 3; attempt++)
            {
                // Where it is cut off is another place each time; what is asserted holds for all of them.
                using var source = new CancellationTokenSource();
                WorldSnapshot whole = cancelled.Snapshot();
                source.CancelAfter(TimeSpan.FromTicks(2_000L * attempt * (step + 1)));
                try
                {
                    cancelled.Step(0.01, source.Token);
                    cancelled.Restore(whole);
                }
                catch (OperationCanceledException)
                {
                    Assert.That((cancelled.StateHash(), cancelled.Time), Is.EqualTo((before, time)));
                }
            }

            plain.Step(0.01);
            cancelled.Step(0.01);
            Assert.That(cancelled.StateHash(), Is.EqualTo(plain.StateHash()), $"step {step}");
            Assert.That((cancelled.Stops, cancelled.Findings.Diagnostics.Count), Is.EqualTo((plain.Stops, plain.Findings.Diagnostics.Count)));
        }
    }

    [Test]
    public void Factor_Cancelled_EndsAmidAWideMatrix()
    {
        var sizes = Enumerable.Repeat(1, 65).ToArray();
        var pattern = new BlockPattern(sizes, Enumerable.Range(1, 64).Select(i => (i - 1, i)));
        var matrix = new double[pattern.Length];
        Assert.That(() => BlockCholesky<ScalarLane>.Factor(pattern, matrix, new CancellationToken(true)), Throws.InstanceOf<OperationCanceledException>());
    }

    private static IEnumerable<string> WithToken() => typeof(World).Assembly.GetExportedTypes()
        .SelectMany(type => type.GetMembers(BindingFlags.Public | BindingFlags.Instance | BindingFlags.Static | BindingFlags.DeclaredOnly))
        .OfType<MethodBase>()
        .Where(call => call.GetParameters().Any(p => p.ParameterType == typeof(CancellationToken)))
        .Select(call => $"{call.DeclaringType!.Name}.{call.Name}");

    private static ValidScene Boxes() => SceneValidator.Validate(new SceneDocument
    {
        GameObjects = Enumerable.Range(0, 2).Select(i => new GameObject { Id = $"b{i}", Name = $"b{i}", Components = [new Rigidbody(), new BoxCollider { Size = new Vector3d(1, 1, 1) }] }).ToArray(),
    }).Scene!;

    private static MechanismState Open(Mechanism mechanism)
    {
        MechanismState state = mechanism.NewState();
        int body = mechanism.Bodies[mechanism.Bodies.Count - 1];
        Pose pose = state.Pose(body);
        state.SetPose(body, new Pose(pose.Position, Quaterniond.AxisAngle(Vector3d.UnitZ, 0.1) * pose.Rotation));
        return state;
    }
}
