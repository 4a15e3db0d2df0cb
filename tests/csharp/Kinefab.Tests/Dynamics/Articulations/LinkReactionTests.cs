using System;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;
using Quaterniond = Kinefab.Numerics.Quaterniond;

namespace Kinefab.Tests.Dynamics.Articulations;

/// <summary>What links' joints carry (CurrentForce, CurrentTorque), with the signs of other joints.</summary>
public sealed class LinkReactionTests
{
    private const double G = 9.81;

    private static readonly ArticulationDrive Limited = new() { LowerLimit = -12, UpperLimit = 50 };

    private static readonly object[] Arms =
    [
        new object[] { "free", new[] { LinkScene.Link(ArticulationJointType.Revolute), LinkScene.Link(ArticulationJointType.Spherical, mass: 0.7), LinkScene.Link(ArticulationJointType.Revolute) }, 2 },
        new object[] { "driven", new[] { LinkScene.Link(ArticulationJointType.Revolute, new ArticulationDrive { Stiffness = 300, Damping = 20, Target = 10 }), LinkScene.Link(ArticulationJointType.Prismatic, new ArticulationDrive { Stiffness = 200, Damping = 5 }), LinkScene.Link(ArticulationJointType.Fixed) }, 2 },
        new object[] { "damped", new[] { LinkScene.Link(ArticulationJointType.Revolute) with { AngularDamping = 0.3, LinearDamping = 0.2 }, LinkScene.Link(ArticulationJointType.Fixed) with { UseGravity = false } }, 2 },
        new object[] { "two arms on one", new[] { LinkScene.Link(ArticulationJointType.Revolute), LinkScene.Link(ArticulationJointType.Spherical, mass: 0.7), LinkScene.Link(ArticulationJointType.Revolute, new ArticulationDrive { Damping = 0.4 }) }, 1 },
    ];

    /// <summary>The exact solver's are those of ConfigurableJoints with the same frames.</summary>
    [TestCaseSource(nameof(Arms))]
    public void CurrentForce_OfLinks_IsThatOfTheExactJointsToTheOrderOfTheStep(string name, ArticulationBody[] links, int thirdBelow)
    {
        double coarse = Gap(0.002), fine = Gap(0.0005);
        Assert.That(coarse, Is.LessThan(0.03), name);
        Assert.That(fine, Is.LessThan(0.4 * coarse), "first order");

        double Gap(double step)
        {
            SceneDocument document = LinkScene.Document(LinkScene.Base, links);
            if (links.Length > 2)
                document = document with { GameObjects = [.. document.GameObjects.Take(3), document.GameObjects[3] with { Parent = thirdBelow }] };
            World unity = World.Create(LinkScene.Valid(document), SolverKind.Unity);
            World exact = World.Create(LinkScene.Valid(document), SolverKind.Exact);
            unity.Run(0.3, step: step);
            exact.Run(0.3, step: step);
            return Enumerable.Range(0, links.Length).Max(i => Math.Max(
                (unity.Joints[i].CurrentForce - exact.Joints[i].CurrentForce).Length / (1 + exact.Joints[i].CurrentForce.Length),
                (unity.Joints[i].CurrentTorque - exact.Joints[i].CurrentTorque).Length / (1 + exact.Joints[i].CurrentTorque.Length)));
        }
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void CurrentForce_OfAnArmThatIsHeld_IsItsWeightAndLever(SolverKind solver)
    {
        World world = LinkScene.World(solver, LinkScene.Link(ArticulationJointType.Fixed), LinkScene.Link(ArticulationJointType.Fixed, mass: 3));
        world.Step(0.02);
        using (Assert.EnterMultipleScope())
        {
            Assert.That((world.Joints[0].CurrentForce - new Vector3d(0, -5 * G, 0)).Length, Is.LessThan(1e-6), "on the link above");
            Assert.That((world.Joints[0].CurrentTorque - new Vector3d(0, 0, -(2 * 0.5 + 3 * 1.5) * G)).Length, Is.LessThan(1e-6));
            Assert.That((world.Joints[1].CurrentForce - new Vector3d(0, -3 * G, 0)).Length, Is.LessThan(1e-6));
            Assert.That((world.Joints[1].CurrentTorque - new Vector3d(0, 0, -3 * 0.5 * G)).Length, Is.LessThan(1e-6));
        }
    }

    /// <summary>A hinge's drive pulls by the angle that is left, not by the sine of its half as a ConfigurableJoint's.</summary>
    [TestCase(SolverKind.Unity, 150)]
    [TestCase(SolverKind.Exact, 150)]
    [TestCase(SolverKind.Unity, -400)]
    [TestCase(SolverKind.Exact, -400)]
    public void Step_DriveFarFromItsTarget_PullsByTheAngleThatIsLeft(SolverKind solver, double target)
    {
        const double stiffness = 0.5, step = 1e-3;
        World world = LinkScene.World(solver, LinkScene.Link(ArticulationJointType.Revolute, new ArticulationDrive { Stiffness = stiffness, Target = target }) with { UseGravity = false });
        world.Step(step);
        double acceleration = stiffness * target / (0.1 + 2 * 0.25);
        Assert.That(((WorldLinkJoint)world.Joints[0]).Speed(Coordinate.AngularX), Is.EqualTo(acceleration * step).Within(1e-4 * Math.Abs(acceleration * step)));
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void CurrentTorque_AgainstALimit_CountsAndAgainstADriveDoesNot(SolverKind solver)
    {
        World limited = LinkScene.World(solver, LinkScene.Link(ArticulationJointType.Revolute, Limited) with { TwistLock = ConfigurableJointMotion.Limited });
        World driven = LinkScene.World(solver, LinkScene.Link(ArticulationJointType.Revolute, new ArticulationDrive { Stiffness = 1e4, Damping = 1e3, Target = -12 }));
        limited.Run(2);
        driven.Run(2);
        double weight = -2 * G * 0.5 * Math.Cos(12 * Math.PI / 180);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(limited.Joints[0].CurrentTorque.Z, Is.EqualTo(weight).Within(0.02));
            Assert.That(driven.Joints[0].CurrentTorque.Length, Is.LessThan(0.02));
            Assert.That((driven.Joints[0].CurrentForce - new Vector3d(0, -2 * G, 0)).Length, Is.LessThan(0.02));
        }
    }

    /// <summary>A beam that its own joint holds at one end and a joint to the world at the other: each carries its share.</summary>
    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void CurrentForce_WithALoop_LeavesOutWhatTheOtherJointCarries(SolverKind solver)
    {
        var tip = new ConfigurableJoint
        {
            ConnectedBody = 1,
            ConnectedAnchor = new Vector3d(0.5, 0, 0),
            AutoConfigureConnectedAnchor = false,
            XMotion = ConfigurableJointMotion.Free,
            YMotion = ConfigurableJointMotion.Locked,
            ZMotion = ConfigurableJointMotion.Free,
            AngularXMotion = ConfigurableJointMotion.Free,
            AngularYMotion = ConfigurableJointMotion.Free,
            AngularZMotion = ConfigurableJointMotion.Free,
        };
        var post = new GameObject { Id = "Post", Name = "Post", Transform = new Transform { LocalPosition = new Vector3d(1.5, 0, 0) }, Components = [new Rigidbody { IsKinematic = true }, tip] };
        World world = World.Create(LinkScene.Valid(LinkScene.Document(LinkScene.Base, [LinkScene.Link(ArticulationJointType.Revolute)], post)), solver);
        world.Run(1);
        WorldJoint link = world.Joints.Single(j => j is WorldLinkJoint);
        WorldJoint held = world.Joints.Single(j => j is not WorldLinkJoint);
        using (Assert.EnterMultipleScope())
        {
            Assert.That((link.CurrentForce - new Vector3d(0, -G, 0)).Length, Is.LessThan(0.02));
            Assert.That((held.CurrentForce - new Vector3d(0, -G, 0)).Length, Is.LessThan(0.02), "on the own body, the post");
        }
    }

    [Test]
    public void CurrentForce_AfterAProgramMovedTheLinks_IsStillThatOfTheStep()
    {
        World world = LinkScene.World(SolverKind.Unity, LinkScene.Link(ArticulationJointType.Revolute), LinkScene.Link(ArticulationJointType.Revolute));
        World other = LinkScene.World(SolverKind.Unity, LinkScene.Link(ArticulationJointType.Revolute), LinkScene.Link(ArticulationJointType.Revolute));
        world.Run(0.2);
        other.Run(0.2);
        ((WorldLinkJoint)world.Joints[1]).SetSpeed(Coordinate.AngularX, 500);
        world.Body("L0").Pose = new Pose(new Vector3d(0, 3, 0), Quaterniond.AxisAngle(Vector3d.UnitY, 1));
        Assert.That(world.Joints[0].CurrentForce, Is.EqualTo(other.Joints[0].CurrentForce));
    }
}
