using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using System.Threading;
using Kinefab.Advice;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
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
    public void CallsOnAWideGrid_CancelledOnTheWay_End()
    {
        ValidScene scene = SceneValidator.Validate(HubScenes.Grid(20)).Scene!;
        Mechanism mechanism = Mechanism.Create(scene);
        var solver = new PositionSolver(mechanism);
        int last = scene.Document.GameObjects.Count - 1;
        var far = new Vector3d(30, -40, 0);
        var calls = new (string Name, Action<CancellationToken> Call)[]
        {
            ("World.Create unity", token => World.Create(scene, SolverKind.Unity, token)),
            ("World.Create exact", token => World.Create(scene, SolverKind.Exact, token)),
            ("PositionSolver", token => _ = new PositionSolver(mechanism, token)),
            ("Close", token => solver.Close(Open(mechanism), token)),
            ("Drag", token => solver.Drag(mechanism.NewState(), last, Vector3d.Zero, far, token)),
            ("Branches", token => solver.Branches(mechanism.NewState(), 0, true, token)),
            ("Step unity", token => World.Create(scene, SolverKind.Unity, CancellationToken.None).Step(0.02, token)),
            ("Step exact", token => World.Create(scene, SolverKind.Exact, CancellationToken.None).Step(0.02, token)),
            ("CountMobility", token => mechanism.CountMobility(null, token)),
        };
        foreach ((string name, Action<CancellationToken> call) in calls)
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

    private static MechanismState Open(Mechanism mechanism)
    {
        MechanismState state = mechanism.NewState();
        int body = mechanism.Bodies[mechanism.Bodies.Count - 1];
        Pose pose = state.Pose(body);
        state.SetPose(body, new Pose(pose.Position, Quaterniond.AxisAngle(Vector3d.UnitZ, 0.1) * pose.Rotation));
        return state;
    }
}
