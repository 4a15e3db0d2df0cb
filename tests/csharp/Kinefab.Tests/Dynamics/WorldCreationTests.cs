using System;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>What a world takes from a scene: frames, anchors, masses, frozen motions, inactive objects.</summary>
public sealed class WorldCreationTests
{
    private static readonly HingeJoint HingeZ = new() { Axis = new Vector3d(0, 0, 3) };

    [Test]
    public void Create_ManyJointsOnOneBody_TakesMemoryInProportion()
    {
        // Unity's solver needs no matrix: a pattern of it would hold every pair of the hub's joints.
        _ = StarBytes(16);
        Assert.That(StarBytes(400), Is.LessThan(2.6 * StarBytes(200)));
    }

    private static double StarBytes(int leaves)
    {
        var hub = new GameObject { Id = "hub", Name = "hub", Components = [new Rigidbody()] };
        GameObject[] around = Enumerable.Range(0, leaves).Select(i => new GameObject
        {
            Id = $"leaf{i}",
            Name = "leaf",
            Transform = new Transform { LocalPosition = new Vector3d(i + 1, 0, 0) },
            Components = [new Rigidbody(), new HingeJoint { Axis = Vector3d.UnitZ, ConnectedBody = 0 }],
        }).ToArray();
        ValidScene scene = SmallScene.Validate(new SceneDocument { GameObjects = [hub, .. around] });
        long before = GC.GetAllocatedBytesForCurrentThread();
        _ = World.Create(scene);
        return GC.GetAllocatedBytesForCurrentThread() - before;
    }

    [Test]
    public void Anchor_ScaledObject_IsScaledComponentByComponent()
    {
        // The anchor (0.5, 0.25, 0) on a child of scale (2, 3, 1) under scale (1, 2, 1): local (1, 1.5, 0), so the
        // pendulum's length is that of (1, 1.5): sqrt(3.25).
        var scene = new SceneDocument
        {
            GameObjects =
            [
                new GameObject { Id = "root", Name = "root", Transform = new Transform { LocalScale = new Vector3d(1, 2, 1) } },
                new GameObject
                {
                    Id = "own",
                    Name = "own",
                    Parent = 0,
                    Transform = new Transform { LocalScale = new Vector3d(2, 1.5, 1) },
                    Components = [new Rigidbody { MaxAngularVelocity = 100 }, new HingeJoint { Axis = Vector3d.UnitZ, Anchor = new Vector3d(0.5, 0.5, 0) }],
                },
            ],
        };
        World world = World.Create(SmallScene.Validate(scene));

        SmallScene.Run(world, 0.7);

        var pivot = new Vector3d(1, 1.5, 0);
        Assert.That((world.Bodies[0].Pose.Position - pivot).Length, Is.EqualTo(Math.Sqrt(3.25)).Within(1e-3));
        Assert.That(world.Bodies[0].Pose.Position.X, Is.Not.EqualTo(0).Within(0.05), "it swings");
    }

    [Test]
    public void ConnectedAnchor_AutoConfigured_TakesTheAnchorsPlace()
    {
        World world = SmallScene.Create(Locked(new Vector3d(0.2, 0.1, -0.3), new Vector3d(9, 9, 9), connectedBody: 1), connected: true);

        SmallScene.Run(world, 0.1);

        Assert.That(SmallScene.Way(world).Length, Is.LessThan(1e-12));
    }

    [Test]
    public void ConnectedAnchor_GivenInAConnectedBody_PullsTheOwnAnchorThere()
    {
        var anchor = new Vector3d(0.2, 0.1, -0.3);
        var connectedAnchor = new Vector3d(-0.1, 0.4, 0.2);
        World world = SmallScene.Create(
            Locked(anchor, connectedAnchor, auto: false, connectedBody: 1),
            connected: true);

        SmallScene.Run(world, 0.5);

        Vector3d gap = world.Bodies[0].Pose.Point(anchor) - SmallScene.ConnectedPose.Point(connectedAnchor);
        Assert.That(gap.Length, Is.LessThan(1e-9));
        Assert.That(SmallScene.Turn(world).Length, Is.LessThan(1e-6), "degrees: the rotation at the start is kept");
    }

    [Test]
    public void ConnectedAnchor_WithoutConnectedBody_StandsInTheWorld()
    {
        var connectedAnchor = new Vector3d(1, 2, 3);
        World world = SmallScene.Create(Locked(connectedAnchor: connectedAnchor, auto: false));

        SmallScene.Run(world, 0.5);

        Assert.That((world.Bodies[0].Pose.Position - connectedAnchor).Length, Is.LessThan(1e-9));
    }

    [Test]
    public void ConfiguredInWorldSpace_Axis_IsAWorldDirection()
    {
        World world = SmallScene.Create(Locked(inWorld: true, axis: Vector3d.UnitY, secondaryAxis: Vector3d.UnitZ, x: ConfigurableJointMotion.Free));
        world.Bodies[0].LinearVelocity = new Vector3d(1, 0.5, -0.7);

        SmallScene.Run(world, 1);

        Vector3d way = world.Bodies[0].Pose.Position - SmallScene.OwnPose.Position;
        Assert.That(way.Y, Is.EqualTo(0.5).Within(1e-6));
        Assert.That(Math.Sqrt(way.X * way.X + way.Z * way.Z), Is.LessThan(1e-9));
    }

    [Test]
    public void SecondaryAxis_NotAtRightAngles_IsMadeSo()
    {
        // Y is what is left of (1, 1, 0) beside X: (0, 1, 0) in the own body.
        World world = SmallScene.Create(Locked(axis: new Vector3d(2, 0, 0), secondaryAxis: new Vector3d(1, 1, 0), y: ConfigurableJointMotion.Free));
        world.Bodies[0].LinearVelocity = SmallScene.OwnPose.Rotation * new Vector3d(0.3, 0.4, 0.5);

        SmallScene.Run(world, 1);

        Vector3d way = SmallScene.Way(world);
        Assert.That((way - new Vector3d(0, 0.4, 0)).Length, Is.LessThan(1e-6));
    }

    [TestCase(false)]
    [TestCase(true)]
    public void SwapBodies_Slide_TurnsWithTheConnectedBody(bool swap)
    {
        // A slide along X and free rotation: without swap the slide's axis turns with the own body.
        World world = SmallScene.Create(
            new ConfigurableJoint
            {
                SwapBodies = swap,
                YMotion = ConfigurableJointMotion.Locked,
                ZMotion = ConfigurableJointMotion.Locked,
                Anchor = new Vector3d(0.4, 0.1, 0),
            });
        world.Bodies[0].AngularVelocity = SmallScene.OwnPose.Rotation * new Vector3d(0, 0, 1.5);
        world.Bodies[0].LinearVelocity = SmallScene.OwnPose.Rotation * new Vector3d(0.8, -0.4, 0);

        SmallScene.Run(world, 0.5);

        var anchor = new Vector3d(0.4, 0.1, 0);
        Vector3d inWorld = world.Bodies[0].Pose.Point(anchor) - SmallScene.OwnPose.Point(anchor);
        Vector3d onTheSlide = (swap ? SmallScene.OwnPose : world.Bodies[0].Pose).Rotation.InverseRotate(inWorld);
        Assert.That(Math.Abs(onTheSlide.Y), Is.LessThan(2e-3));
        Assert.That(inWorld.Length, Is.GreaterThan(0.05), "it slides");
    }

    [Test]
    public void FreezePosition_WorldAxis_DoesNotMove([Values] SolverKind solver)
    {
        World world = SmallScene.Create(HingeZ, new Rigidbody { Constraints = RigidbodyConstraints.FreezePositionX }, solver: solver);
        world.Bodies[0].AddForce(new Vector3d(5, 5, 5));
        world.Bodies[0].AddTorque(new Vector3d(1, 2, 3));

        SmallScene.Run(world, 0.3);

        Assert.That(world.Bodies[0].Pose.Position.X, Is.EqualTo(SmallScene.OwnPose.Position.X).Within(1e-12));
    }

    [Test]
    public void FreezePosition_TwoWorldAxesExact_SlidesAlongTheThirdAndTurnsFreely()
    {
        var own = new Rigidbody
        {
            Mass = 2,
            AngularDamping = 0,
            InertiaTensor = new Vector3d(2, 2, 2),
            Constraints = RigidbodyConstraints.FreezePositionX | RigidbodyConstraints.FreezePositionZ,
        };
        World world = SmallScene.Create(new ConfigurableJoint(), own, solver: SolverKind.Exact);

        for (int i = 0; i < 50; i++)
        {
            world.Bodies[0].AddForce(new Vector3d(5, 6, 7));
            world.Bodies[0].AddTorque(new Vector3d(0, 0, 3));
            world.Step(SmallScene.Dt);
        }

        // F t^2 / 2m = 6 * 0.25 / 4 along Y; M t / I = 3 * 0.5 / 2 about Z. The joint is the scene's only one.
        Vector3d way = world.Bodies[0].Pose.Position - SmallScene.OwnPose.Position;
        Assert.That((way - new Vector3d(0, 0.375, 0)).Length, Is.LessThan(1e-9));
        Assert.That((world.Bodies[0].AngularVelocity - new Vector3d(0, 0, 0.75)).Length, Is.LessThan(1e-9));
        Assert.That(world.Joints, Has.Count.EqualTo(1));
    }

    [Test]
    public void FreezeRotation_PrincipalAxis_TakesNoTorque([Values] SolverKind solver)
    {
        World world = SmallScene.Create(new ConfigurableJoint(), new Rigidbody { Constraints = RigidbodyConstraints.FreezeRotationY, AngularDamping = 0, InertiaTensor = new Vector3d(1, 2, 2.5) }, solver: solver);
        world.Bodies[0].AddTorque(SmallScene.OwnPose.Rotation * new Vector3d(1, 4, 0));

        world.Step(0.01);

        Vector3d w = SmallScene.OwnPose.Rotation.InverseRotate(world.Bodies[0].AngularVelocity);
        Assert.That((w - new Vector3d(0.01, 0, 0)).Length, Is.LessThan(1e-12));
    }

    [Test]
    public void InertiaTensorRotation_Torque_ActsOnTheTurnedPrincipalAxes()
    {
        // Principal axes turned by 90 degrees about Z: local Y is the principal X, with 4 kg m^2.
        Quaterniond turn = Quaterniond.AxisAngle(Vector3d.UnitZ, Math.PI / 2);
        World world = SmallScene.Create(new ConfigurableJoint(), new Rigidbody { AngularDamping = 0, InertiaTensor = new Vector3d(4, 2, 5), InertiaTensorRotation = turn });
        world.Bodies[0].AddTorque(SmallScene.OwnPose.Rotation * new Vector3d(1, 1, 0));

        world.Step(0.1);

        Vector3d w = SmallScene.OwnPose.Rotation.InverseRotate(world.Bodies[0].AngularVelocity);
        Assert.That((w - new Vector3d(0.05, 0.025, 0)).Length, Is.LessThan(1e-12));
    }

    [Test]
    public void CenterOfMass_Offset_IsWhereTheBodyTurns()
    {
        var com = new Vector3d(0.2, -0.1, 0.3);
        World world = SmallScene.Create(new ConfigurableJoint(), new Rigidbody { AngularDamping = 0, CenterOfMass = com });
        world.Bodies[0].AngularVelocity = new Vector3d(0, 2, 0);

        SmallScene.Run(world, 1);

        Assert.That((world.Bodies[0].Pose.Point(com) - SmallScene.OwnPose.Point(com)).Length, Is.LessThan(1e-12));
        Assert.That(SmallScene.Way(world).Length, Is.GreaterThan(0.1));
    }

    [Test]
    public void Step_JointsAtOdds_AreNamedOnce()
    {
        // Held to the world where it stands, and by a second joint to a place 5 m away.
        ConfigurableJoint far = Locked(connectedAnchor: new Vector3d(5, 0, 0), auto: false);
        SceneDocument document = SmallScene.Document(Locked(), new Rigidbody(), connected: false);
        GameObject own = document.GameObjects[0];
        var twice = new GameObject { Id = own.Id, Name = own.Name, Transform = own.Transform, Components = [.. own.Components, far] };
        World world = World.Create(SmallScene.Validate(new SceneDocument { Physics = document.Physics, GameObjects = [twice] }), SolverKind.Exact);
        for (int i = 0; i < 5; i++)
        {
            world.Step(0.02);
        }

        Diagnostic found = world.Findings.Diagnostics.Single(d => d.Code == DiagnosticCodes.StepUnsolved);
        Assert.That((found.Severity, found.Pointer.StartsWith("/gameObjects/0/components/", StringComparison.Ordinal)), Is.EqualTo((Severity.Warning, true)));
        Assert.That(found.Message, Does.Contain("own").And.Contain("from 0 s"));
        Assert.That(found.Remedy, Is.EqualTo("Close the joint in the pose that the step began from. Else take a shorter step."), "there are no limits and no drives");
        Assert.That(world.Stops, Is.Positive);
    }

    [Test]
    public void Speeds_ThatTheJointsForbid_AreTakenOffAtOnceAndTold()
    {
        World world = SmallScene.Create(Locked(), solver: SolverKind.Exact);
        world.Bodies[0].LinearVelocity = new Vector3d(1, 2, 3);
        world.Bodies[0].AngularVelocity = new Vector3d(0.1, -0.2, 0.3);
        for (int i = 0; i < 5; i++)
        {
            world.Step(0.02);
        }

        Diagnostic found = world.Findings.Diagnostics.Single();
        Assert.That((found.Code, found.Severity, found.Pointer), Is.EqualTo((DiagnosticCodes.StartSpeedForbidden, Severity.Warning, "/gameObjects/0/components/1")));
        Assert.That(world.Stops, Is.Zero);
        Assert.That(world.Bodies[0].LinearVelocity.Length, Is.LessThan(1e-9));
    }

    [TestCase(false, "degrees/s")]
    [TestCase(true, "m/s")]
    public void Speeds_ThatAGearForbids_AreToldInTheUnitOfWhatFollows(bool isRack, string unit)
    {
        const ConfigurableJointMotion l = ConfigurableJointMotion.Locked;
        Component follower = isRack
            ? new ConfigurableJoint { XMotion = ConfigurableJointMotion.Free, YMotion = l, ZMotion = l, AngularXMotion = l, AngularYMotion = l, AngularZMotion = l }
            : new HingeJoint { Axis = Vector3d.UnitZ };
        var scene = new SceneDocument
        {
            GameObjects = [Body("driver", new HingeJoint { Axis = Vector3d.UnitZ }), Body("follower", follower)],
            Couplings = [new Coupling { Kind = isRack ? CouplingKind.Rack : CouplingKind.Gear, A = At(0, Coordinate.Angle), B = At(1, isRack ? Coordinate.X : Coordinate.Angle), Ratio = -2.5 }],
        };
        World world = World.Create(SmallScene.Validate(scene), SolverKind.Exact);
        world.Bodies[0].AngularVelocity = 3 * Vector3d.UnitZ;
        world.Step(0.02);
        Diagnostic found = world.Findings.Diagnostics.Single();
        Assert.That((found.Code, found.Pointer), Is.EqualTo((DiagnosticCodes.StartSpeedForbidden, "/gameObjects/1/components/1")));
        Assert.That(found.Message, Does.Contain($" {unit}"));

        static JointCoordinate At(int body, Coordinate coordinate) => new() { GameObject = body, Component = 1, Coordinate = coordinate };

        static GameObject Body(string id, Component joint) => new() { Id = id, Name = id, Components = [new Rigidbody { Mass = 1, InertiaTensor = new Vector3d(1, 1, 1) }, joint] };
    }

    // Damping takes of turning not what it takes of going, so that what is left is not as the joint has it.
    [TestCase(0, 0.05)]
    [TestCase(0.5, 0)]
    [TestCase(2, 3)]
    public void Speeds_ThatTheJointsAllow_AreNotTold_WhateverTheDamping(double linear, double angular)
    {
        var anchor = new Vector3d(0.1, 0.4, -0.2);
        Vector3d axis = SmallScene.OwnPose.Rotation * Vector3d.UnitZ;
        World world = SmallScene.Create(new HingeJoint { Anchor = anchor, Axis = Vector3d.UnitZ }, new Rigidbody { LinearDamping = linear, AngularDamping = angular }, solver: SolverKind.Exact);
        world.Bodies[0].AngularVelocity = 3 * axis;
        world.Bodies[0].LinearVelocity = Vector3d.Cross(3 * axis, SmallScene.OwnPose.Rotation * -anchor);
        world.Step(0.02);
        Assert.That(world.Findings.Diagnostics, Is.Empty);
        Assert.That(world.Bodies[0].AngularVelocity.Length, Is.LessThan(3).And.GreaterThan(2.8));
    }

    [Test]
    public void MassScale_ExactSolver_IsNamedAsIgnored()
    {
        ConfigurableJoint scaled = Locked(auto: false, massScale: 4);

        World exact = SmallScene.Create(scaled, solver: SolverKind.Exact);

        Diagnostic found = exact.Findings.Diagnostics.Single();
        Assert.That((found.Code, found.Severity, found.Pointer), Is.EqualTo((DiagnosticCodes.MassScaleIgnored, Severity.Warning, "/gameObjects/0/components/1")));
        Assert.That(found.Message, Does.Contain("massScale 4"));
        Assert.That(SmallScene.Create(scaled).Findings.Diagnostics, Is.Empty, "Unity's solver follows it");

        // As well where a program asks for it later, once.
        World later = SmallScene.Create(Locked(auto: false), solver: SolverKind.Exact), unity = SmallScene.Create(Locked(auto: false));
        foreach (World world in new[] { later, unity, later, exact })
        {
            var joint = (WorldConfigurableJoint)world.Joints[0];
            joint.Settings = joint.Settings with { MassScale = 3 };
        }

        Assert.That(later.Findings.Diagnostics.Select(one => (one.Code, one.Pointer)), Is.EqualTo([(found.Code, found.Pointer)]));
        Assert.That(later.Findings.Diagnostics[0].Message, Does.Contain("massScale 3"));
        Assert.That((unity.Findings.Diagnostics.Count, exact.Findings.Diagnostics.Count), Is.EqualTo((0, 1)));
        Assert.That(SmallScene.Create(Locked(auto: false), solver: SolverKind.Exact).Findings.Diagnostics, Is.Empty);
    }

    [Test]
    public void MassScale_OwnBody_MovesAsIfLighter()
    {
        // Two free bodies of 1 kg, fixed to each other 0.1 m apart: with massScale 4 the joint sees 1/4 kg on the own
        // side, so that one goes four times as far.
        SceneDocument document = SmallScene.Document(
            Locked(auto: false, connectedBody: 1, massScale: 4),
            new Rigidbody(),
            connected: false);
        var scene = new SceneDocument
        {
            Physics = document.Physics,
            GameObjects =
            [
                new GameObject { Id = "a", Name = "a", Transform = new Transform { LocalPosition = new Vector3d(0.1, 0, 0) }, Components = document.GameObjects[0].Components },
                new GameObject { Id = "b", Name = "b", Components = [new Rigidbody()] },
            ],
        };
        World world = World.Create(SmallScene.Validate(scene));

        world.Step(0.01);

        double own = 0.1 - world.Bodies[0].Pose.Position.X;
        double other = world.Bodies[1].Pose.Position.X;
        Assert.That(own / other, Is.EqualTo(4).Within(1e-9));
    }

    [Test]
    public void Inactive_Body_IsNotSimulatedAndHoldsItsJointsToTheWorld()
    {
        SceneDocument document = SmallScene.Document(Locked(connectedBody: 1), new Rigidbody(), connected: true);
        GameObject other = document.GameObjects[1];
        var scene = new SceneDocument
        {
            GameObjects = [document.GameObjects[0], new GameObject { Id = other.Id, Name = other.Name, Active = false, Transform = other.Transform, Components = other.Components }],
        };
        World world = World.Create(SmallScene.Validate(scene));

        SmallScene.Run(world, 0.5);

        Assert.That(world.Bodies, Has.Count.EqualTo(1));
        Assert.That(SmallScene.Way(world).Length, Is.LessThan(1e-6));
    }

    [Test]
    public void Create_WithoutScene_Throws() => Assert.That(() => World.Create(null!), Throws.ArgumentNullException);

    /// <summary>All six freedoms locked but the given slides.</summary>
    private static ConfigurableJoint Locked(
        Vector3d? anchor = null,
        Vector3d? connectedAnchor = null,
        bool auto = true,
        int? connectedBody = null,
        Vector3d? axis = null,
        Vector3d? secondaryAxis = null,
        bool inWorld = false,
        double massScale = 1,
        ConfigurableJointMotion x = ConfigurableJointMotion.Locked,
        ConfigurableJointMotion y = ConfigurableJointMotion.Locked) => new()
    {
        Anchor = anchor ?? Vector3d.Zero,
        Axis = axis ?? Vector3d.UnitX,
        SecondaryAxis = secondaryAxis ?? Vector3d.UnitY,
        AutoConfigureConnectedAnchor = auto,
        ConnectedAnchor = connectedAnchor ?? Vector3d.Zero,
        ConnectedBody = connectedBody,
        ConfiguredInWorldSpace = inWorld,
        MassScale = massScale,
        XMotion = x,
        YMotion = y,
        ZMotion = ConfigurableJointMotion.Locked,
        AngularXMotion = ConfigurableJointMotion.Locked,
        AngularYMotion = ConfigurableJointMotion.Locked,
        AngularZMotion = ConfigurableJointMotion.Locked,
    };
}
