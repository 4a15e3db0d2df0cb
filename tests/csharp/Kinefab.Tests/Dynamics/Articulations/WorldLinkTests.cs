using System;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;
using Quaterniond = Kinefab.Numerics.Quaterniond;

namespace Kinefab.Tests.Dynamics.Articulations;

/// <summary>Articulations of a scene in a world, by either solver.</summary>
public sealed class WorldLinkTests
{
    private const ArticulationJointType Revolute = ArticulationJointType.Revolute;
    private const ArticulationJointType Prismatic = ArticulationJointType.Prismatic;
    private const ArticulationJointType Spherical = ArticulationJointType.Spherical;

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void Step_Pendulum_SwingsWithTheClosedFormsPeriod(SolverKind solver)
    {
        // Released at 5 degrees from hanging: T = 2 pi sqrt(I / m g r) (1 + a^2/16).
        World world = LinkScene.World(solver, LinkScene.Link(Revolute));
        var joint = (WorldLinkJoint)world.Joints[0];
        joint.SetPosition(Coordinate.AngularX, -85);
        double amplitude = 5 * Math.PI / 180;
        double period = 2 * Math.PI * Math.Sqrt((0.1 + 2 * 0.25) / (2 * 9.81 * 0.5)) * (1 + amplitude * amplitude / 16);
        RunResult run = world.Run(period, record: ["L1"], step: period / 2000);
        Assert.That(run["L1"][^1], Is.EqualTo(-85).Within(0.05));
        Assert.That(run["L1"].Min(), Is.EqualTo(-95).Within(0.05));
    }

    [TestCase(SolverKind.Unity, ArticulationDriveType.Force)]
    [TestCase(SolverKind.Unity, ArticulationDriveType.Acceleration)]
    [TestCase(SolverKind.Unity, ArticulationDriveType.Target)]
    [TestCase(SolverKind.Exact, ArticulationDriveType.Force)]
    [TestCase(SolverKind.Exact, ArticulationDriveType.Acceleration)]
    [TestCase(SolverKind.Exact, ArticulationDriveType.Target)]
    public void Step_DrivenToATarget_ReachesItInItsOwnSense(SolverKind solver, ArticulationDriveType type)
    {
        var drive = new ArticulationDrive { Stiffness = 1e6, Damping = 1e5, Target = 40, DriveType = type };
        World world = LinkScene.World(solver, LinkScene.Link(Revolute, drive), LinkScene.Link(Prismatic, drive with { Target = 0.2 }));
        world.Run(4);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(world["L1"], Is.EqualTo(40).Within(0.1));
            Assert.That(world["L2"], Is.EqualTo(0.2).Within(1e-3));
            Assert.That(world.Body("L1").Pose.Rotation.Z, Is.EqualTo(Math.Sin(20 * Math.PI / 180)).Within(1e-3), "left-handed about Z");
        }
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void Step_DriveOfTypeVelocity_HoldsTheSpeed(SolverKind solver)
    {
        var drive = new ArticulationDrive { TargetVelocity = 30, DriveType = ArticulationDriveType.Velocity };
        World world = LinkScene.World(solver, LinkScene.Link(Prismatic, drive with { TargetVelocity = 0.05 }), LinkScene.Link(Revolute, drive));
        world.Run(2);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(world["L2"], Is.EqualTo(60).Within(0.7));
            Assert.That(world["L1"], Is.EqualTo(0.1).Within(2e-3));
            Assert.That(((WorldLinkJoint)world.Joints[1]).Speed(Coordinate.AngularX), Is.EqualTo(30).Within(0.05));
        }
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void DriveToAndAt_ByName_MoveTheLink(SolverKind solver)
    {
        World world = LinkScene.World(solver, LinkScene.Link(Prismatic), LinkScene.Link(Revolute));
        world.DriveTo("L2", -35);
        world.DriveAt("L1", 0.04);
        world.Run(2);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(world["L2.angularX"], Is.EqualTo(-35).Within(0.05));
            Assert.That(world["L1.x"], Is.EqualTo(0.08).Within(1e-3));
        }
    }

    [TestCase(SolverKind.Unity, 0.1)]
    [TestCase(SolverKind.Exact, 0.1)]
    public void Step_LimitsThatLieLopsided_Hold(SolverKind solver, double within)
    {
        World world = LinkScene.World(
            solver,
            LinkScene.Link(Revolute, new ArticulationDrive { LowerLimit = -20, UpperLimit = 50 }) with { TwistLock = ConfigurableJointMotion.Limited },
            LinkScene.Link(Prismatic, new ArticulationDrive { LowerLimit = -0.1, UpperLimit = 0.3, Damping = 5 }) with { LinearLock = ConfigurableJointMotion.Limited });
        RunResult run = world.Run(3, record: ["L1", "L2"]);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(run["L1"].Min(), Is.EqualTo(-20).Within(within));
            Assert.That(run["L2"].Max(), Is.EqualTo(0.3).Within(2e-3), "slides down the sloping arm");
        }
    }

    [Test]
    public void Step_TumblingInFreeSpace_KeepsMomentumAndEnergyToTheOrderOfTheStep()
    {
        double coarse = Loss(0.004), fine = Loss(0.002);
        Assert.That(coarse, Is.LessThan(0.02));
        Assert.That(fine, Is.LessThan(0.65 * coarse), "first order");

        static double Loss(double step)
        {
            ArticulationBody root = LinkScene.Base with { Immovable = false, UseGravity = false, AngularDamping = 0 };
            World world = World.Create(LinkScene.Scene(root, LinkScene.Link(Revolute) with { UseGravity = false }, LinkScene.Link(Spherical) with { UseGravity = false }));
            WorldBody body = world.Body("L0");
            body.AngularVelocity = new Vector3d(0.4, 0.8, -0.5);
            world.Step(step);
            (double energy, Vector3d linear, Vector3d angular) = (world.KineticEnergy, Linear(world), Angular(world));
            world.Run(1, step: step);
            return Math.Abs(world.KineticEnergy - energy) / energy + (Linear(world) - linear).Length / 3 + (Angular(world) - angular).Length / angular.Length;
        }
    }

    /// <summary>The same open chain as links and as Rigidbodies with joints in the exact solver.</summary>
    [Test]
    public void Step_ArticulationAndExactJoints_AgreeToTheOrderOfTheStep()
    {
        double coarse = Gap(0.002), fine = Gap(0.001);
        Assert.That(coarse, Is.LessThan(0.02));
        Assert.That(fine, Is.LessThan(0.65 * coarse), "first order");

        static double Gap(double step)
        {
            ArticulationBody[] links = [LinkScene.Link(Revolute), LinkScene.Link(Spherical), LinkScene.Link(Prismatic, new ArticulationDrive { Stiffness = 200, Damping = 2 })];
            World unity = LinkScene.World(SolverKind.Unity, links);
            World exact = LinkScene.World(SolverKind.Exact, links);
            unity.Run(0.6, step: step);
            exact.Run(0.6, step: step);
            return (unity.Body("L3").Pose.Position - exact.Body("L3").Pose.Position).Length;
        }
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void SetPositionAndSpeed_OfALink_MoveAllBelow(SolverKind solver)
    {
        World world = LinkScene.World(solver, LinkScene.Link(Revolute) with { UseGravity = false }, LinkScene.Link(Revolute) with { UseGravity = false });
        var first = (WorldLinkJoint)world.Joints[0];
        first.SetPosition(Coordinate.AngularX, 90);
        Assert.That((world.Body("L2").Pose.Position - new Vector3d(0.5, 1.5, 0)).Length, Is.LessThan(1e-9));
        first.SetSpeed(Coordinate.AngularX, 90);
        world.Step(0.01);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(first.Speed(Coordinate.AngularX), Is.EqualTo(90).Within(2));
            Assert.That(world["L1"], Is.EqualTo(90.9).Within(0.02));
        }
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void DriveTo_OfALinkAfterDriveAt_HasItsOwnSpring(SolverKind solver)
    {
        var drive = new ArticulationDrive { Stiffness = 100, Damping = 20 };
        World world = LinkScene.World(solver, LinkScene.Link(Revolute, drive) with { UseGravity = false });
        var joint = (WorldLinkJoint)world.Joints[0];
        joint.DriveAt(Coordinate.AngularX, 60);
        world.Run(0.1);
        joint.DriveTo(Coordinate.AngularX, 30);
        world.Run(10, until: _ =>
        {
            joint.AddForce(Coordinate.AngularX, 10);
            return false;
        });
        Assert.That(world["L1"], Is.EqualTo(30 + 10.0 / 100 * 180 / Math.PI).Within(1e-3));
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void SetPosition_BeyondHalfATurn_IsWhereItIsCountedFrom(SolverKind solver)
    {
        World world = LinkScene.World(solver, LinkScene.Link(Revolute) with { UseGravity = false });
        var joint = (WorldLinkJoint)world.Joints[0];
        joint.SetPosition(Coordinate.AngularX, 270);
        Assert.That(world["L1"], Is.EqualTo(270).Within(1e-9));
        joint.DriveTo(Coordinate.AngularX, 300);
        RunResult run = world.Run(4, record: ["L1"]);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(run["L1"][^1], Is.EqualTo(300).Within(1e-3));
            Assert.That(run["L1"].Min(), Is.EqualTo(270).Within(1e-3), "by the way between");
        }
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void Pose_OfTheRoot_TakesTheArticulationAlong(SolverKind solver)
    {
        World world = LinkScene.World(solver, LinkScene.Link(Revolute) with { UseGravity = false });
        world.Body("L0").Pose = new Pose(new Vector3d(0, 2, 0), Quaterniond.AxisAngle(Vector3d.UnitY, Math.PI / 2));
        world.Step(0.02);
        using (Assert.EnterMultipleScope())
        {
            Assert.That((world.Body("L1").Pose.Position - new Vector3d(0, 2, -1)).Length, Is.LessThan(1e-9));
            Assert.That(() => world.Body("L1").Pose = Pose.Identity, Throws.InvalidOperationException);
        }
    }

    // In unity a link's velocities follow from its joints' speeds, and what was set was lost.
    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void Velocities_OfALink_AreSetOfTheRootAlone(SolverKind solver)
    {
        World world = LinkScene.World(solver, LinkScene.Link(Revolute));
        using (Assert.EnterMultipleScope())
        {
            Assert.That(() => world.Body("L1").LinearVelocity = Vector3d.UnitX, Throws.InvalidOperationException.With.Message.Contains("set its joint's speed"));
            Assert.That(() => world.Body("L1").AngularVelocity = Vector3d.UnitX, Throws.InvalidOperationException);
            Assert.That(() => world.Body("L0").LinearVelocity = Vector3d.UnitX, Throws.Nothing);
        }
    }

    // The limit of force of a drive without gains holds of DriveTo too, which forgot it.
    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void DriveToAndAt_OfADriveWithAForceAlone_GiveNoMore(SolverKind solver)
    {
        foreach (bool isSpeed in new[] { false, true })
        {
            World world = LinkScene.World(solver, LinkScene.Link(Prismatic, new ArticulationDrive { ForceLimit = 3 }) with { UseGravity = false, LinearDamping = 0 });
            if (isSpeed)
                world.DriveAt("L1", 10);
            else
                world.DriveTo("L1", 10);
            world.Run(1);
            Assert.That(world.Body("L1").LinearVelocity.Length, Is.EqualTo(1.5).Within(0.02), isSpeed ? "at" : "to");
        }
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void AddForce_OnACoordinate_HoldsTheWeight(SolverKind solver)
    {
        World world = LinkScene.World(solver, LinkScene.Link(Revolute));
        for (int i = 0; i < 50; i++)
        {
            ((WorldLinkJoint)world.Joints[0]).AddForce(Coordinate.AngularX, 2 * 9.81 * 0.5);
            world.Step(0.02);
        }

        Assert.That(world["L1"], Is.Zero.Within(1e-3));
    }

    [Test]
    public void Restore_Snapshot_GivesTheSameBitsAgain()
    {
        World world = LinkScene.World(SolverKind.Unity, LinkScene.Link(Revolute), LinkScene.Link(Spherical), LinkScene.Link(Prismatic, new ArticulationDrive { Stiffness = 100 }));
        world.Run(0.5);
        WorldSnapshot snapshot = world.Snapshot();
        world.DriveTo("L1", 20);
        world.Run(0.5);
        Pose[] poses = [.. world.Bodies.Select(b => b.Pose)];
        world.Restore(snapshot);
        world.DriveTo("L1", 20);
        world.Run(0.5);
        Assert.That(world.Bodies.Select(b => b.Pose), Is.EqualTo(poses));
    }

    [Test]
    public void Friction_AboveTheWeight_HoldsAndTheExactSolverSaysThatItHasNone()
    {
        ArticulationBody link = LinkScene.Link(Revolute) with { JointFriction = 3 };
        World world = LinkScene.World(SolverKind.Unity, link);
        world.Run(1);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(world["L1"], Is.Zero.Within(0.2));
            Assert.That(LinkScene.World(SolverKind.Exact, link).Findings.Diagnostics.Select(d => d.Code), Is.EqualTo("LINK_NOT_EXACT".Split()));
        }
    }

    [Test]
    public void Drive_OfABall_TheExactSolverSaysThatItFollowsSines()
    {
        ArticulationBody still = LinkScene.Link(Spherical), driven = LinkScene.Link(Spherical, new ArticulationDrive { Stiffness = 100 });
        using (Assert.EnterMultipleScope())
        {
            Assert.That(LinkScene.World(SolverKind.Exact, still).Findings.Diagnostics, Is.Empty);
            Assert.That(LinkScene.World(SolverKind.Exact, driven).Findings.Diagnostics.Select(d => d.Code), Is.EqualTo("LINK_NOT_EXACT".Split()));
        }
    }

    [Test]
    public void MaxJointVelocity_OfALink_IsNotPassed()
    {
        World world = LinkScene.World(SolverKind.Unity, LinkScene.Link(Revolute) with { MaxJointVelocity = 1 });
        double fastest = 0;
        for (int i = 0; i < 100; i++)
        {
            world.Step(0.02);
            fastest = Math.Max(fastest, Math.Abs(((WorldLinkJoint)world.Joints[0]).Speed(Coordinate.AngularX)));
        }

        Assert.That(fastest, Is.EqualTo(180 / Math.PI).Within(0.01));
    }

    [TestCase(ArticulationDriveType.Force, 100.0)]
    [TestCase(ArticulationDriveType.Acceleration, 0.0)]
    [TestCase(ArticulationDriveType.Acceleration, 100.0)]
    public void AccelerationDrive_OfAHinge_TheExactSolverSaysThatItIsScaledByTheBodiesAlone(ArticulationDriveType type, double stiffness)
    {
        // Its own turn has a moment of 0.1 kg m^2, 0.6 about the hinge: q'' = stiffness (target - q) in unity, a sixth of it in exact.
        ArticulationBody link = LinkScene.Link(Revolute, new ArticulationDrive { Stiffness = stiffness, Target = 10, DriveType = type }) with { UseGravity = false };
        World exact = LinkScene.World(SolverKind.Exact, link), unity = LinkScene.World(SolverKind.Unity, link);
        exact.Run(0.05, step: 1e-4);
        unity.Run(0.05, step: 1e-4);
        bool isTold = exact.Findings.Diagnostics.Any(d => d.Code == "LINK_NOT_EXACT" && d.Message.Contains("acceleration drives"));
        using (Assert.EnterMultipleScope())
        {
            Assert.That(isTold, Is.EqualTo(Math.Abs(exact["L1"] - unity["L1"]) > 0.1));
            Assert.That(isTold, Is.EqualTo(type == ArticulationDriveType.Acceleration && stiffness > 0));
        }
    }

    [TestCase(SolverKind.Unity, 7.0)]
    [TestCase(SolverKind.Exact, 7.0)]
    [TestCase(SolverKind.Unity, 12.0)]
    [TestCase(SolverKind.Exact, 12.0)]
    public void DefaultMaxAngularSpeed_OfALink_SlowsItByItsOwnInertia(SolverKind solver, double most)
    {
        // What is held back is the link's own turn; its mass, on an arm of half a metre, keeps its speed.
        const double step = 0.002;
        const double share = 0.1 / (0.1 + 2 * 0.25);
        SceneDocument document = LinkScene.Document(LinkScene.Base, [LinkScene.Link(Revolute) with { UseGravity = false }]);
        World world = World.Create(LinkScene.Valid(document with { Physics = document.Physics with { DefaultMaxAngularSpeed = most } }), solver);
        var joint = (WorldLinkJoint)world.Joints[0];
        joint.SetSpeed(Coordinate.AngularX, 20 * 180 / Math.PI);
        for (int i = 1; i <= 10; i++)
        {
            world.Step(step);
            Assert.That(joint.Speed(Coordinate.AngularX) * Math.PI / 180, Is.EqualTo(most + (20 - most) * Math.Pow(1 - share, i)).Within(1e-3));
        }
    }

    /// <summary>A loop of links that a joint of a helper closes, and a coupling of two links' coordinates.</summary>
    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void Step_CouplingOfTwoLinks_KeepsTheirRatio(SolverKind solver)
    {
        ArticulationBody[] links = [LinkScene.Link(Revolute), LinkScene.Link(Revolute)];
        SceneDocument document = LinkScene.Document(LinkScene.Base, links) with
        {
            Couplings = [new Coupling { Id = "gear", A = At(1), B = At(2), Ratio = -0.5 }],
        };
        World world = World.Create(LinkScene.Valid(document), solver);
        world.Run(0.5);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(Math.Abs(world["L1"]), Is.GreaterThan(20));
            Assert.That(world["L2"], Is.EqualTo(-0.5 * world["L1"]).Within(0.3));
        }

    }

    /// <summary>A third link follows two others: six bodies in one row.</summary>
    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void Step_LinkThatFollowsTwo_KeepsTheirSum(SolverKind solver)
    {
        ArticulationBody[] links = [LinkScene.Link(Revolute), LinkScene.Link(Revolute), LinkScene.Link(Revolute)];
        SceneDocument document = LinkScene.Document(LinkScene.Base, links) with
        {
            Couplings = [new Coupling { B = At(3), Terms = [new CouplingTerm { Coordinate = At(1), Ratio = 0.5 }, new CouplingTerm { Coordinate = At(2), Ratio = -0.25 }] }],
        };
        World world = World.Create(LinkScene.Valid(document), solver);
        world.Run(0.5);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(Math.Abs(world["L1"]), Is.GreaterThan(5));
            Assert.That(world["L3"], Is.EqualTo(0.5 * world["L1"] - 0.25 * world["L2"]).Within(0.3));
        }
    }

    private static JointCoordinate At(int link) => new() { GameObject = link, Component = 0, Coordinate = Coordinate.AngularX };

    [Test]
    public void Step_WithoutRows_AllocatesNothing()
    {
        World world = LinkScene.World(SolverKind.Unity, LinkScene.Link(Revolute, new ArticulationDrive { Stiffness = 100, Damping = 10 }), LinkScene.Link(Spherical));
        world.Run(0.2);
        Assert.That(AllocatedBytes.LeastOf(Run), Is.Zero);

        void Run()
        {
            for (int i = 0; i < 100; i++)
                world.Step(0.02);
        }
    }

    [Test]
    public void Step_OnHugeNumbers_StopsAndThrowsNothing()
    {
        ArticulationBody[] links = [LinkScene.Link(Revolute) with { MaxJointVelocity = 1e300 }, LinkScene.Link(Prismatic) with { MaxJointVelocity = 1e300 }];
        World world = LinkScene.World(SolverKind.Unity, links);
        world.Gravity = new Vector3d(0, -1e300, 1e300);
        for (int i = 0; i < 20; i++)
            world.Step(0.02);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(world.Stops, Is.Positive);
            Assert.That(world.Bodies.All(b => b.Pose.Position.IsFinite), Is.True);
        }
    }

    /// <summary>The middle of the range, from which a ConfigurableJoint counts, is another.</summary>
    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void Settings_OtherLimitsOfASlide_HoldWhereTheyAre(SolverKind solver)
    {
        ArticulationBody slide = LinkScene.Link(Prismatic, new ArticulationDrive { Stiffness = 200, Damping = 40, Target = 5, LowerLimit = 0, UpperLimit = 1 }) with
        {
            LinearLock = ConfigurableJointMotion.Limited,
            UseGravity = false,
        };
        World world = LinkScene.World(solver, slide);
        var joint = (WorldLinkJoint)world.Joints[0];
        world.Run(3);
        Assert.That(world["L1"], Is.EqualTo(1).Within(1e-3));
        WorldSnapshot snapshot = world.Snapshot();
        joint.Settings = joint.Settings with { XDrive = joint.Settings.XDrive with { UpperLimit = 0.4 } };
        Assert.That(world["L1"], Is.EqualTo(1).Within(1e-3), "counted as before");
        world.Run(3);
        Assert.That(world["L1"], Is.EqualTo(0.4).Within(1e-3));
        joint.Settings = joint.Settings with { XDrive = joint.Settings.XDrive with { LowerLimit = -0.3, Target = -5 } };
        world.Run(3);
        Assert.That(world["L1"], Is.EqualTo(-0.3).Within(1e-3));
        joint.DriveTo(Coordinate.X, 0.1);
        world.Run(3);
        Assert.That(world["L1"], Is.EqualTo(0.1).Within(1e-2), "driven");
        world.Restore(snapshot);
        world.Run(1);
        Assert.That(world["L1"], Is.EqualTo(1).Within(1e-3), "restored");
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void Settings_OtherLimitsOfASlideThatIsCoupled_KeepTheRatio(SolverKind solver)
    {
        ArticulationBody limited = LinkScene.Link(Prismatic, new ArticulationDrive { Stiffness = 50, Damping = 20, Target = 0.2, LowerLimit = -1, UpperLimit = 0.5 }) with
        {
            LinearLock = ConfigurableJointMotion.Limited,
            UseGravity = false,
        };
        ArticulationBody free = LinkScene.Link(Prismatic) with { UseGravity = false };
        SceneDocument document = LinkScene.Document(LinkScene.Base, [limited, free]) with
        {
            Couplings = [new Coupling { Kind = CouplingKind.Linear, A = Along(1), B = Along(2), Ratio = 2 }],
        };
        World world = World.Create(LinkScene.Valid(document), solver);
        world.Run(0.5);
        var joint = (WorldLinkJoint)world.Joints[0];
        joint.Settings = joint.Settings with { XDrive = joint.Settings.XDrive with { LowerLimit = -0.1, UpperLimit = 0.3 } };
        world.Run(3);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(world["L1"], Is.EqualTo(0.2).Within(0.02));
            Assert.That(world["L2"], Is.EqualTo(2 * world["L1"]).Within(1e-4));
        }

        static JointCoordinate Along(int link) => new() { GameObject = link, Component = 0, Coordinate = Coordinate.X };
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void Pose_OfTheRootThatTurns_KeepsTheJointsSpeeds(SolverKind solver)
    {
        ArticulationBody link = LinkScene.Link(Revolute) with { UseGravity = false };
        World world = LinkScene.World(solver, link);
        var joint = (WorldLinkJoint)world.Joints[0];
        joint.SetSpeed(Coordinate.AngularX, 90);
        world.Step(0.02);
        world.Bodies[0].Pose = new Pose(new Vector3d(1, 2, 3), Quaterniond.AxisAngle(Vector3d.UnitX, Math.PI / 2));
        Assert.That(joint.Speed(Coordinate.AngularX), Is.EqualTo(90).Within(1e-6));
        world.Run(1, step: 0.002);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(joint.Speed(Coordinate.AngularX), Is.EqualTo(90).Within(1e-3));
            Assert.That(world["L1"], Is.EqualTo(91.8).Within(2e-3));
        }
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void KinematicTarget_OfALink_IsRefused(SolverKind solver)
    {
        World world = LinkScene.World(solver, LinkScene.Link(Revolute));
        Assert.That(() => world.Bodies[0].KinematicTarget = Pose.Identity, Throws.InvalidOperationException.With.Message.Contains("root"));
    }

    /// <summary>A link without joints is a rigid body.</summary>
    [TestCase(1, 1)]
    [TestCase(6, 1)]
    [TestCase(0.3, 5)]
    public void Step_MassScalesOfAJointToALink_AreThoseOfAJointToARigidbody(double own, double connected)
    {
        var inertia = new Vector3d(0.3, 0.3, 0.3);
        var spring = new JointDrive { PositionSpring = 400, PositionDamper = 3, MaximumForce = 1e6 };
        double[] toLink = Places(new ArticulationBody { Mass = 3, InertiaTensor = inertia, AngularDamping = 0.05, LinearDamping = 0, UseGravity = false });
        double[] toBody = Places(new Rigidbody { Mass = 3, InertiaTensor = inertia, AngularDamping = 0.05, LinearDamping = 0, UseGravity = false });
        Assert.That(toLink, Is.EqualTo(toBody).Within(1e-9));

        double[] Places(Component other)
        {
            var joint = new ConfigurableJoint
            {
                ConnectedBody = 0,
                XDrive = spring,
                TargetPosition = new Vector3d(0.5, 0, 0),
                AngularXMotion = ConfigurableJointMotion.Locked,
                MassScale = own,
                ConnectedMassScale = connected,
                EnablePreprocessing = false,
            };
            var document = new SceneDocument
            {
                GameObjects =
                [
                    new() { Id = "other", Name = "other", Components = [other] },
                    new()
                    {
                        Id = "own",
                        Name = "own",
                        Transform = new Transform { LocalPosition = new Vector3d(1, 0, 0) },
                        Components = [new Rigidbody { Mass = 2, InertiaTensor = inertia, UseGravity = false }, joint],
                    },
                ],
            };
            World world = World.Create(LinkScene.Valid(document), SolverKind.Unity);
            world.Run(0.2);
            return [world.Body("other").Pose.Position.X, world.Body("own").Pose.Position.X];
        }
    }

    private static Vector3d Linear(World world) => world.Bodies.Aggregate(Vector3d.Zero, (sum, b) => sum + b.LinearVelocity * b.Settings.Mass);

    private static Vector3d Angular(World world)
    {
        double mass = world.Bodies.Sum(b => b.Settings.Mass);
        Vector3d center = world.Bodies.Aggregate(Vector3d.Zero, (sum, b) => sum + b.CenterOfMass * b.Settings.Mass) * (1 / mass);
        return world.Bodies.Aggregate(Vector3d.Zero, (sum, b) =>
        {
            Quaterniond q = b.Pose.Rotation;
            Vector3d spin = q * Vector3d.Scale(b.Settings.InertiaTensor, q.Conjugate() * b.AngularVelocity);
            return sum + spin + Vector3d.Cross(b.CenterOfMass - center, b.LinearVelocity * b.Settings.Mass);
        });
    }
}
