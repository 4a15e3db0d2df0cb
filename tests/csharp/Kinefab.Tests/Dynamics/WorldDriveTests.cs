using System;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>Joints driven by coordinate: the own body's motion against the connected one, whatever Unity's field would be called.</summary>
public sealed class WorldDriveTests
{
    private const ConfigurableJointMotion Locked = ConfigurableJointMotion.Locked;
    private const ConfigurableJointMotion Free = ConfigurableJointMotion.Free;

    [Test]
    public void DriveTo_Hinge_ReachesTheAngleWithoutGainsOfItsOwn()
    {
        World world = SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ });

        world.Joints[0].DriveTo(Coordinate.Angle, -70);
        SmallScene.Run(world, 2);

        Assert.That(SmallScene.Turn(world).Z, Is.EqualTo(-70).Within(1e-3));
    }

    [Test]
    public void DriveAt_Hinge_HoldsTheSpeed()
    {
        World world = SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ, ConnectedBody = 1 }, connected: true);

        world.Joints[0].DriveAt(Coordinate.Angle, 45);
        SmallScene.Run(world, 2);

        Assert.That(SmallScene.Turn(world).Z, Is.EqualTo(90).Within(1e-3));
    }

    [TestCase(Coordinate.X, false)]
    [TestCase(Coordinate.Y, true)]
    [TestCase(Coordinate.Z, false)]
    public void DriveTo_Slide_ReachesThePlace(Coordinate coordinate, bool swap)
    {
        World world = SmallScene.Create(Only(coordinate, swap));

        world.Joints[0].DriveTo(coordinate, 0.23);
        SmallScene.Run(world, 2);

        Assert.That(SmallScene.Way(world)[coordinate - Coordinate.X], Is.EqualTo(0.23).Within(1e-5));
    }

    [TestCase(Coordinate.AngularX, true)]
    [TestCase(Coordinate.AngularY, false)]
    [TestCase(Coordinate.AngularZ, true)]
    public void DriveTo_Angle_ReachesTheAngle(Coordinate coordinate, bool swap)
    {
        World world = SmallScene.Create(Only(coordinate, swap));

        world.Joints[0].DriveTo(coordinate, 33);
        SmallScene.Run(world, 2);

        Assert.That(SmallScene.Turn(world)[coordinate - Coordinate.AngularX], Is.EqualTo(33).Within(1e-3));
    }

    [Test]
    public void DriveTo_AnyNumberOfTurns_ReachesIt([Values] SolverKind solver, [Values(190, -200, 800, -1000)] double target)
    {
        World hinge = SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ }, solver: solver);
        World twist = SmallScene.Create(Only(Coordinate.AngularX, swap: true), solver: solver);
        World swing = SmallScene.Create(Only(Coordinate.AngularY, swap: false), solver: solver);

        foreach ((World world, Coordinate coordinate) in new[] { (hinge, Coordinate.Angle), (twist, Coordinate.AngularX), (swing, Coordinate.AngularY) })
        {
            world.Joints[0].DriveTo(coordinate, target);
            SmallScene.Run(world, 5);
            Assert.That(world.Joints[0].Coordinate(coordinate), Is.EqualTo(target).Within(1e-3), $"{coordinate}");
            world.Joints[0].DriveTo(coordinate, -target);
            SmallScene.Run(world, 5);
            Assert.That(world.Joints[0].Coordinate(coordinate), Is.EqualTo(-target).Within(1e-3), $"{coordinate}, all the way back");
            Assert.That((world.Stops, world.Findings.Diagnostics.Count), Is.EqualTo((0, 0)));
        }
    }

    [Test]
    public void DriveTo_AfterItArrived_StaysAtRest([Values] SolverKind solver)
    {
        World hinge = SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ }, solver: solver);
        World slide = SmallScene.Create(Only(Coordinate.Z, swap: true), solver: solver);

        hinge.Joints[0].DriveTo(Coordinate.Angle, 30);
        slide.Joints[0].DriveTo(Coordinate.Z, -0.1);
        SmallScene.Run(hinge, 60);
        SmallScene.Run(slide, 60);

        Assert.That(hinge.Joints[0].Coordinate(Coordinate.Angle), Is.EqualTo(30).Within(1e-6));
        Assert.That(slide.Joints[0].Coordinate(Coordinate.Z), Is.EqualTo(-0.1).Within(1e-8));
        Assert.That((hinge.Stops, slide.Stops), Is.EqualTo((0, 0)));
    }

    [Test]
    public void DriveAt_MoreThanHalfATurnAStep_IsCounted([Values] SolverKind solver)
    {
        World hinge = SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ }, new Rigidbody { AngularDamping = 0, MaxAngularVelocity = 1000 }, solver: solver);
        World twist = SmallScene.Create(Only(Coordinate.AngularX, swap: false), new Rigidbody { AngularDamping = 0, MaxAngularVelocity = 1000 }, solver: solver);

        hinge.Joints[0].DriveAt(Coordinate.Angle, -24000);
        twist.Joints[0].DriveAt(Coordinate.AngularX, 24000);
        SmallScene.Run(hinge, 0.1);
        SmallScene.Run(twist, 0.1);
        double angle = hinge.Joints[0].Coordinate(Coordinate.Angle);
        double turn = twist.Joints[0].Coordinate(Coordinate.AngularX);
        SmallScene.Run(hinge, 0.1);
        SmallScene.Run(twist, 0.1);

        Assert.That(hinge.Joints[0].Coordinate(Coordinate.Angle) - angle, Is.EqualTo(-2400).Within(1));
        Assert.That(twist.Joints[0].Coordinate(Coordinate.AngularX) - turn, Is.EqualTo(2400).Within(1));
    }

    /// <summary>A wheel that gears drive has no drive of its own: at 3,000 turns a minute it comes round once in each step.</summary>
    [TestCase(9000, 2)]
    [TestCase(9000, 3)]
    [TestCase(12000, -1.5)]
    public void DriveAt_GearedToMoreThanHalfATurnAStep_IsCounted(double speed, double ratio)
    {
        JointCoordinate At(int wheel) => new() { GameObject = wheel, Component = 1, Coordinate = Coordinate.Angle };
        GameObject Wheel(string id, double x) => new()
        {
            Id = id, Name = id, Transform = SmallScene.At(new Pose(new Vector3d(x, 0, 0), Quaterniond.Identity)),
            Components = [new Rigidbody { AngularDamping = 0, MaxAngularVelocity = 1000 }, new HingeJoint { Axis = Vector3d.UnitZ }],
        };
        World world = World.Create(
            SmallScene.Validate(new SceneDocument
            {
                Physics = new Physics { Gravity = Vector3d.Zero }, GameObjects = [Wheel("a", 0), Wheel("b", 2)],
                Couplings = [new Coupling { Kind = CouplingKind.Gear, A = At(0), B = At(1), Ratio = ratio }],
            }),
            SolverKind.Exact);

        world.Joints[0].DriveAt(Coordinate.Angle, speed);
        for (int i = 0; i < 50; i++)
        {
            world.Step(0.02);
        }

        Assert.That(world.Joints[1].Coordinate(Coordinate.Angle), Is.EqualTo(ratio * world.Joints[0].Coordinate(Coordinate.Angle)).Within(1e-3));
    }

    [TestCase(Coordinate.X, false, 0.2)]
    [TestCase(Coordinate.Z, true, -0.2)]
    public void DriveAt_Slide_HoldsTheSpeed(Coordinate coordinate, bool swap, double speed)
    {
        World world = SmallScene.Create(Only(coordinate, swap));

        world.Joints[0].DriveAt(coordinate, speed);
        SmallScene.Run(world, 1);

        Assert.That(SmallScene.Way(world)[coordinate - Coordinate.X], Is.EqualTo(speed).Within(1e-4));
    }

    [TestCase(Coordinate.AngularX, false, 30)]
    [TestCase(Coordinate.AngularY, true, -30)]
    public void DriveAt_Angle_HoldsTheSpeed(Coordinate coordinate, bool swap, double speed)
    {
        World world = SmallScene.Create(Only(coordinate, swap));

        world.Joints[0].DriveAt(coordinate, speed);
        SmallScene.Run(world, 1);

        Assert.That(SmallScene.Turn(world)[coordinate - Coordinate.AngularX], Is.EqualTo(speed).Within(1e-2));
    }

    [Test]
    public void DriveTo_ShiftedConnectedAnchor_CountsFromTheStart()
    {
        // The slide's connected anchor stands 0.1 m beyond the own one, as for an asymmetric range.
        ConfigurableJoint joint = Only(Coordinate.X, swap: false, SmallScene.OwnPose.Point(new Vector3d(0.1, 0, 0)));
        World world = SmallScene.Create(joint);

        Assert.That(world.Joints[0].Coordinate(Coordinate.X), Is.Zero);
        world.Joints[0].DriveTo(Coordinate.X, 0.15);
        SmallScene.Run(world, 2);

        Assert.That(SmallScene.Way(world).X, Is.EqualTo(0.15).Within(1e-5));
    }

    /// <summary>In exact a goal prescribes the motion: any load is moved as none would be. The spring of before was 6e-6 rad behind under 1 N m.</summary>
    [Test]
    public void DriveTo_Exact_IsMetWhateverTheLoad()
    {
        World hinge = SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ }, solver: SolverKind.Exact);
        World slide = SmallScene.Create(Only(Coordinate.Y, swap: true), solver: SolverKind.Exact);
        World twist = SmallScene.Create(Only(Coordinate.AngularX, swap: true), solver: SolverKind.Exact);
        World swing = SmallScene.Create(Only(Coordinate.AngularZ, swap: false), solver: SolverKind.Exact);
        const double goal = 40;
        const double steps = 30;
        double left = Math.Pow(1 / (1 + SmallScene.Dt / 0.1 + 0.5 * Math.Pow(SmallScene.Dt / 0.1, 2)), steps);

        foreach ((World world, Coordinate coordinate) in new[] { (hinge, Coordinate.Angle), (slide, Coordinate.Y), (twist, Coordinate.AngularX), (swing, Coordinate.AngularZ) })
        {
            world.Joints[0].DriveTo(coordinate, goal);
            for (int i = 0; i < steps; i++)
            {
                world.Bodies[0].AddTorque(new Vector3d(500, -300, 400));
                world.Bodies[0].AddForce(new Vector3d(-1000, 2000, 500));
                world.Step(SmallScene.Dt);
            }

            Assert.That(world.Joints[0].Coordinate(coordinate), Is.EqualTo(goal * (1 - left)).Within(1e-5), $"{coordinate}");
            Assert.That((world.Stops, world.Findings.Diagnostics.Count), Is.EqualTo((0, 0)), $"{coordinate}");
        }
    }

    /// <summary>A drive's force limit bounds what may be given to prescribe the motion, which then comes later.</summary>
    [Test]
    public void DriveTo_WithAForceLimit_GivesNoMore()
    {
        const double force = 3;
        ConfigurableJoint joint = Only(Coordinate.X, swap: false);
        joint = joint with { XDrive = new JointDrive { PositionDamper = 1, MaximumForce = force } };
        World world = SmallScene.Create(joint, new Rigidbody { Mass = 2, LinearDamping = 0 }, solver: SolverKind.Exact);

        world.Joints[0].DriveTo(Coordinate.X, 0.01);
        for (int i = 1; i <= 4; i++)
        {
            world.Step(SmallScene.Dt);
            Assert.That(world.Bodies[0].LinearVelocity.Length, Is.EqualTo(force / 2 * i * SmallScene.Dt).Within(1e-9));
        }

        SmallScene.Run(world, 5);
        Assert.That(world.Joints[0].Coordinate(Coordinate.X), Is.EqualTo(0.01).Within(1e-6));
        Assert.That(world.Stops, Is.Zero);
    }

    /// <summary>A goal beyond a limit is held there, without a stop.</summary>
    [Test]
    public void DriveTo_BeyondALimit_RestsAtIt([Values] SolverKind solver)
    {
        World world = SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ, UseLimits = true, Limits = new JointLimits { Min = -20, Max = 50 } }, solver: solver);

        world.Joints[0].DriveTo(Coordinate.Angle, 90);
        SmallScene.Run(world, 2);

        Assert.That(world.Joints[0].Coordinate(Coordinate.Angle), Is.EqualTo(50).Within(solver == SolverKind.Exact ? 1e-6 : 1));
        world.Joints[0].DriveTo(Coordinate.Angle, 10);
        SmallScene.Run(world, 2);
        Assert.That(world.Joints[0].Coordinate(Coordinate.Angle), Is.EqualTo(10).Within(1e-3));
        Assert.That((world.Stops, world.Findings.Diagnostics.Count), Is.EqualTo((0, 0)));
    }

    /// <summary>A damper that still wants the speed of before would hold the spring a tenth of a second of it beyond the goal: here 6 degrees, or 10 mm.</summary>
    [Test]
    public void DriveTo_AfterDriveAt_ReachesTheGoal([Values] SolverKind solver, [Values(Coordinate.X, Coordinate.AngularX, Coordinate.AngularY)] Coordinate coordinate)
    {
        World world = SmallScene.Create(Only(coordinate, swap: true), solver: solver);
        double unit = coordinate == Coordinate.X ? 1e-3 : 1;

        world.Joints[0].DriveAt(coordinate, 60 * unit);
        SmallScene.Run(world, 1);
        world.Joints[0].DriveTo(coordinate, 30 * unit);
        SmallScene.Run(world, 4);

        Assert.That(world.Joints[0].Coordinate(coordinate), Is.EqualTo(30 * unit).Within(1e-3 * unit));
    }

    [Test]
    public void DriveTo_AfterDriveAt_HasTheComponentsOwnSpring([Values] SolverKind solver)
    {
        ConfigurableJoint joint = Only(Coordinate.X, swap: false) with { XDrive = new JointDrive { PositionSpring = 100, PositionDamper = 20 } };
        World world = SmallScene.Create(joint, solver: solver);

        world.Joints[0].DriveAt(Coordinate.X, 0.1);
        world.Step(SmallScene.Dt);
        world.Joints[0].DriveTo(Coordinate.X, 0.05);
        for (int i = 0; i < 500; i++)
        {
            world.Bodies[0].AddForce(SmallScene.OwnPose.Rotation * Vector3d.UnitX);
            world.Step(SmallScene.Dt);
        }

        Assert.That(world.Joints[0].Coordinate(Coordinate.X), Is.EqualTo(0.05 + 1.0 / 100).Within(1e-6));
    }

    /// <summary>The two swings have one drive in Unity: what one was asked took the other along, so that Y came to 0 here as Z was sent to 15.</summary>
    [Test]
    public void Drives_OfBothSwings_AreEachTheirOwn([Values] SolverKind solver, [Values] bool isTwistFree)
    {
        ConfigurableJoint joint = Swings(isTwistFree);
        World places = SmallScene.Create(joint, solver: solver), speeds = SmallScene.Create(joint, solver: solver), mixed = SmallScene.Create(joint, solver: solver);

        places.Joints[0].DriveTo(Coordinate.AngularY, 20);
        places.Joints[0].DriveTo(Coordinate.AngularZ, 15);
        speeds.Joints[0].DriveAt(Coordinate.AngularY, 20);
        speeds.Joints[0].DriveAt(Coordinate.AngularZ, 15);
        mixed.Joints[0].DriveAt(Coordinate.AngularY, 20);
        mixed.Joints[0].DriveTo(Coordinate.AngularZ, 15);
        SmallScene.Run(places, 3);
        SmallScene.Run(speeds, 0.5);
        SmallScene.Run(mixed, 2);

        using (Assert.EnterMultipleScope())
        {
            Assert.That(places.Joints[0].Coordinate(Coordinate.AngularY), Is.EqualTo(20).Within(0.01));
            Assert.That(places.Joints[0].Coordinate(Coordinate.AngularZ), Is.EqualTo(15).Within(0.01));
            Assert.That(speeds.Joints[0].Coordinate(Coordinate.AngularY), Is.EqualTo(10).Within(0.1));
            Assert.That(speeds.Joints[0].Coordinate(Coordinate.AngularZ), Is.EqualTo(7.5).Within(0.1));

            // About Y the speed is that of the connected frame's own axis, which leans by the 15 degrees.
            Assert.That(mixed.Joints[0].Coordinate(Coordinate.AngularY), Is.EqualTo(40).Within(3));
            Assert.That(mixed.Joints[0].Coordinate(Coordinate.AngularZ), Is.EqualTo(15).Within(0.1));
            Assert.That(mixed.Findings.Diagnostics, Is.Empty);
        }

        mixed.Joints[0].DriveTo(Coordinate.AngularY, 5);
        SmallScene.Run(mixed, 3);
        Assert.That((mixed.Joints[0].Coordinate(Coordinate.AngularY), mixed.Joints[0].Coordinate(Coordinate.AngularZ)), Is.EqualTo((5.0, 15.0)).Using<(double, double)>((a, b) => Math.Abs(a.Item1 - b.Item1) + Math.Abs(a.Item2 - b.Item2) < 0.02));
    }

    /// <summary>In Unity the two swings have one drive: it holds the one that nobody drives by itself.</summary>
    [Test]
    public void DriveTo_OneSwing_HoldsTheOther([Values] SolverKind solver)
    {
        World world = SmallScene.Create(Swings(isTwistFree: false), solver: solver);

        world.Bodies[0].AngularVelocity = SmallScene.OwnPose.Rotation * new Vector3d(0, 0, 1);
        world.Joints[0].DriveTo(Coordinate.AngularY, 20);
        SmallScene.Run(world, 1);

        Assert.That(world.Joints[0].Coordinate(Coordinate.AngularZ), Is.Zero.Within(0.1));
        Assert.That(world.Joints[0].Coordinate(Coordinate.AngularY), Is.EqualTo(20).Within(0.1));
    }

    [Test]
    public void Drives_OfASlerpDriveThatDiffer_AreNamedOnce([Values] bool isSpeedLast)
    {
        World world = SmallScene.Create(Swings(isTwistFree: true) with { RotationDriveMode = RotationDriveMode.Slerp, SlerpDrive = new JointDrive { PositionDamper = 1 } });

        for (int i = 0; i < 3; i++)
        {
            world.Joints[0].DriveAt(Coordinate.AngularY, 20);
            world.Joints[0].DriveTo(Coordinate.AngularZ, 15);
            if (isSpeedLast)
                world.Joints[0].DriveAt(Coordinate.AngularY, 20);
        }

        Diagnostic found = world.Findings.Diagnostics.Single();
        Assert.That((found.Code, found.Pointer), Is.EqualTo((DiagnosticCodes.DriveShared, "/gameObjects/0/components/1")));
        Assert.That(found.Message, Does.StartWith("angularZ is driven to a goal, and by the same drive, the joint's slerp drive, angularY too: its speed is given up."));
        World alike = SmallScene.Create(Swings(isTwistFree: true) with { RotationDriveMode = RotationDriveMode.Slerp, SlerpDrive = new JointDrive { PositionDamper = 1 } });
        alike.Joints[0].DriveTo(Coordinate.AngularY, 20);
        alike.Joints[0].DriveTo(Coordinate.AngularZ, 15);
        Assert.That(alike.Findings.Diagnostics, Is.Empty);
    }

    /// <summary>A force of 0 is none that was stated, whether the coordinate is sent or turned.</summary>
    [Test]
    public void Drives_WithoutAForce_MoveTheJoint([Values] SolverKind solver, [Values(0, 50)] double spring)
    {
        ConfigurableJoint joint = Only(Coordinate.X, swap: false) with { XDrive = new JointDrive { PositionSpring = spring, PositionDamper = 20, MaximumForce = 0 } };
        World to = SmallScene.Create(joint, solver: solver), at = SmallScene.Create(joint, solver: solver);

        to.Joints[0].DriveTo(Coordinate.X, 0.1);
        at.Joints[0].DriveAt(Coordinate.X, 0.1);
        SmallScene.Run(to, 5);
        SmallScene.Run(at, 1);

        Assert.That((to.Joints[0].Coordinate(Coordinate.X), at.Joints[0].Coordinate(Coordinate.X)), Is.EqualTo((0.1, 0.1)).Using<(double, double)>((a, b) => Math.Abs(a.Item1 - b.Item1) < 1e-3 && Math.Abs(a.Item2 - b.Item2) < 1e-3));
    }

    [Test]
    public void DriveTo_CoordinateOfAnotherKind_Throws()
    {
        World hinge = SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ });
        World fixedJoint = SmallScene.Create(new FixedJoint());
        World configurable = SmallScene.Create(Only(Coordinate.X, swap: false));

        Assert.That(() => hinge.Joints[0].DriveTo(Coordinate.X, 1), Throws.ArgumentException);
        Assert.That(() => fixedJoint.Joints[0].DriveAt(Coordinate.X, 1), Throws.ArgumentException);
        Assert.That(() => configurable.Joints[0].Coordinate(Coordinate.Angle), Throws.ArgumentException);
    }

    private static ConfigurableJoint Swings(bool isTwistFree) => Only(Coordinate.AngularY, swap: false) with
    {
        AngularXMotion = isTwistFree ? Free : Locked,
        AngularZMotion = Free,
    };

    private static ConfigurableJoint Only(Coordinate coordinate, bool swap, Vector3d? connectedAnchor = null) => new()
    {
        SwapBodies = swap,
        AutoConfigureConnectedAnchor = connectedAnchor is null,
        ConnectedAnchor = connectedAnchor ?? Vector3d.Zero,
        XMotion = coordinate == Coordinate.X ? Free : Locked,
        YMotion = coordinate == Coordinate.Y ? Free : Locked,
        ZMotion = coordinate == Coordinate.Z ? Free : Locked,
        AngularXMotion = coordinate == Coordinate.AngularX ? Free : Locked,
        AngularYMotion = coordinate == Coordinate.AngularY ? Free : Locked,
        AngularZMotion = coordinate == Coordinate.AngularZ ? Free : Locked,
    };
}
