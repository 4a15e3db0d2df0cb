using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>Many steps in one call, and drives by names.</summary>
public sealed class WorldRunTests
{
    [Test]
    public void Run_WithRecord_KeepsTheStartAndEveryStep([Values] SolverKind solver)
    {
        World world = SmallScene.Create(new HingeJoint(), solver: solver);
        world.DriveAt("own", 40);
        RunResult run = world.Run(0.5, record: ["own", "own.angle"], step: SmallScene.Dt);
        Assert.That(run.Times, Has.Count.EqualTo(51));
        Assert.That(run.Times[0], Is.Zero);
        Assert.That(run.Times[^1], Is.EqualTo(0.5).Within(1e-12));
        Assert.That(run["own"][0], Is.Zero);
        Assert.That(run["own"][^1], Is.EqualTo(world["own"]).And.EqualTo(20).Within(0.1));
        Assert.That(run["own.angle"], Is.EqualTo(run["own"]));
        Assert.That(run.HasEnded, Is.False);
        Assert.That(run.ToString(), Does.StartWith("50 steps to 0.5 s; own "));
    }

    [Test]
    public void Run_Until_EndsAtTheStepThatDoesIt()
    {
        World world = SmallScene.Create(new HingeJoint());
        world.DriveAt("own", 100);
        RunResult run = world.Run(10, until: w => w["own"] >= 30, record: ["own"], step: SmallScene.Dt);
        Assert.That(run.HasEnded, Is.True);
        Assert.That(run["own"].Count(value => value >= 30), Is.EqualTo(1));
        Assert.That(run.Times, Has.Count.EqualTo(run["own"].Count));
    }

    [Test]
    public void Run_WithoutAStep_TakesTheScenes()
    {
        SceneDocument document = SmallScene.Document(new HingeJoint(), new Rigidbody(), false);
        World world = World.Create(SmallScene.Validate(document with { Physics = document.Physics with { FixedTimestep = 0.025 } }));
        Assert.That(world.Run(0.1).Times, Is.EqualTo(new[] { 0, 0.025, 0.05, 0.075, 0.1 }).Within(1e-15));
    }

    [TestCase(0)]
    [TestCase(-1)]
    [TestCase(double.NaN)]
    [TestCase(double.PositiveInfinity)]
    [TestCase(1e12)]
    public void Run_NoTime_IsRefused(double seconds) =>
        Assert.That(() => SmallScene.Create(new HingeJoint()).Run(seconds), Throws.InstanceOf<ArgumentOutOfRangeException>());

    [Test]
    public void Run_Cancelled_StopsBetweenSteps()
    {
        World world = SmallScene.Create(new HingeJoint());
        using var cancellation = new CancellationTokenSource();
        var told = new List<int>();
        var progress = new Told<int>(step =>
        {
            told.Add(step);
            if (step == 3)
                cancellation.Cancel();
        });
        Assert.That(() => world.Run(1, step: 0.01, progress: progress, cancellation: cancellation.Token), Throws.InstanceOf<OperationCanceledException>());
        Assert.That(told, Is.EqualTo([1, 2, 3]));
        Assert.That(world.Time, Is.EqualTo(0.03).Within(1e-15));
    }

    [Test]
    public void Run_WrongName_SaysWhichThereAre()
    {
        World world = SmallScene.Create(new ConfigurableJoint { ExtrasJson = "{\"name\": \"Ball\"}" });
        Assert.That(() => world.Run(1, record: ["Bell"]), Throws.ArgumentException.With.Message.Contains("own.x \"Ball\""));
        Assert.That(() => world["Ball"], Throws.ArgumentException.With.Message.StartsWith("Ball: say which: own.x \"Ball\", own.y"));
        Assert.That(() => world.Run(1, record: ["Ball.x"])["y"], Throws.ArgumentException.With.Message.Contains("recorded: Ball.x"));
        Assert.That(world.Time, Is.EqualTo(1).Within(1e-9));
    }

    // Each axis reads its own goal: q_i / q_w = tan(goal_i / 2).
    [TestCase(30, 20, 0)]
    [TestCase(30, 0, -25)]
    [TestCase(-10, 80, 0)]
    [TestCase(15, -35, 50)]
    public void DriveTo_SeveralAxesOfABall_AddUp(double x, double y, double z)
    {
        foreach (SolverKind solver in new[] { SolverKind.Unity, SolverKind.Exact })
        {
            foreach (bool isSwapped in new[] { false, true })
            {
                World world = SmallScene.Create(Ball(isSwapped), connected: true, solver: solver);
                world.DriveTo("own.angularX", x);
                world.DriveTo("own.angularY", y);
                if (z != 0)
                    world.DriveTo("own.angularZ", z);
                world.Run(5, step: SmallScene.Dt);
                Assert.That(new[] { world["own.angularX"], world["own.angularY"], world["own.angularZ"] }, Is.EqualTo(new[] { x, y, z }).Within(0.05), $"{solver} {isSwapped}");
            }
        }
    }

    [Test]
    public void DriveTo_OneAxisAgain_LeavesTheOther()
    {
        World world = SmallScene.Create(Ball(false), solver: SolverKind.Exact);
        world.DriveTo("own.angularX", 30);
        world.DriveTo("own.angularY", 20);
        world.DriveTo("own.angularX", -40);
        world.Run(5, step: SmallScene.Dt);
        Assert.That(new[] { world["own.angularX"], world["own.angularY"] }, Is.EqualTo(new[] { -40, 20 }).Within(0.05));
    }

    [Test]
    public void Settings_WithOneField_KeepTheOthers()
    {
        World world = SmallScene.Create(new HingeJoint { UseLimits = true, Limits = new JointLimits { Min = -10, Max = 80, Bounciness = 0.4 }, BreakForce = 900, Closure = true });
        var joint = (WorldHingeJoint)world.Joints[0];
        joint.Settings = joint.Settings with { UseLimits = false };
        Assert.That(joint.Settings, Is.EqualTo(new HingeJoint { UseLimits = false, Limits = joint.Settings.Limits, BreakForce = 900, Closure = true }));
        Assert.That((joint.Settings.Limits.Min, joint.Settings.Limits.Max, joint.Settings.Limits.Bounciness), Is.EqualTo((-10, 80, 0.4)));
    }

    [Test]
    public void BodySettings_Changed_ActFromTheNextStep([Values] SolverKind solver)
    {
        World world = SmallScene.Create(new ConfigurableJoint(), solver: solver);
        WorldBody body = world.Bodies[0];
        world.Step(SmallScene.Dt);
        body.Settings = body.Settings with { Mass = 4, InertiaTensor = new Vector3d(0.5, 2, 2.3) };
        body.AddForce(new Vector3d(10, 0, 0));
        body.AddTorque(body.Pose.Rotation * new Vector3d(3, 0, 0));
        world.Step(SmallScene.Dt);
        Assert.That(body.LinearVelocity.X, Is.EqualTo(10 * SmallScene.Dt / 4).Within(1e-9));
        Assert.That(body.AngularVelocity.Length, Is.EqualTo(3 * SmallScene.Dt / 0.5).Within(1e-9));
    }

    [Test]
    public void BodySettings_DecidedAtCreationOrWrong_AreRefused()
    {
        WorldBody body = SmallScene.Create(new HingeJoint()).Bodies[0];
        Rigidbody before = body.Settings;
        Assert.That(() => body.Settings = before with { IsKinematic = true }, Throws.ArgumentException);
        Assert.That(() => body.Settings = before with { CenterOfMass = new Vector3d(1, 0, 0) }, Throws.ArgumentException);
        Assert.That(() => body.Settings = before with { Mass = -1 }, Throws.ArgumentException.With.Message.Contains("mass"));
        Assert.That(() => body.Settings = null!, Throws.InstanceOf<ArgumentNullException>());
        Assert.That(body.Settings, Is.SameAs(before));
    }

    private static ConfigurableJoint Ball(bool isSwapped) => new()
    {
        XMotion = ConfigurableJointMotion.Locked,
        YMotion = ConfigurableJointMotion.Locked,
        ZMotion = ConfigurableJointMotion.Locked,
        ConnectedBody = null,
        SwapBodies = isSwapped,
    };

    private sealed class Told<T>(Action<T> what) : IProgress<T>
    {
        public void Report(T value) => what(value);
    }
}
