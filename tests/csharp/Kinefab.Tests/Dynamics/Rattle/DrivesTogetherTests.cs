using System;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;
using Transform = Kinefab.Document.Transform;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>
/// Drives without limit of force of one chain, in which nothing is in the way: each does as it is told, whatever the others do. How much one may need was
/// reckoned from its own speed and from loads alone: it let go when another set out (an elbow gave by 25 degrees as the shoulder did) or went round
/// (by 51 degrees, for good), and was named as one that the mechanism does not let move.
/// </summary>
internal sealed class DrivesTogetherTests
{
    private const double BarLength = 0.5;
    private const double Tolerance = 1e-3;

    [TestCase(0.02, 90, 0, 1)]
    [TestCase(1.0 / 60, 90, 0, 1)]
    [TestCase(0.005, 90, 0, 1)]
    [TestCase(0.02, 90, 0, 5)]
    [TestCase(0.02, -90, 30, 0.2)]
    [TestCase(1.0 / 240, 30, -20, 1)]
    public void DriveTo_OfTheShoulder_MovesNoElbow(double dt, double goal, double held, double forearm)
    {
        World world = Arm(dt, 9.81, forearm);
        world.DriveTo("ShoulderJ", 0);
        world.DriveTo("ElbowJ", held);
        Run(world, 2);
        world.DriveTo("ShoulderJ", goal);
        for (int i = 0; i < 2 / dt; i++)
        {
            world.Step(dt);
            Assert.That(world["ElbowJ"], Is.EqualTo(held).Within(Tolerance), $"at {world.Time} s");
        }

        Assert.That(world["ShoulderJ"], Is.EqualTo(goal).Within(Tolerance));
        Assert.That(world.Findings.Diagnostics, Is.Empty);
    }

    [TestCase(0.01, 300)]
    [TestCase(0.005, 700)]
    [TestCase(0.001, 1500)]
    public void DriveAt_OfTheShoulderAtManyTurns_MovesNoElbow(double dt, double perMinute)
    {
        const double held = 60;
        const int rises = 100;
        World world = Arm(dt, 0, 1);
        world.DriveTo("ElbowJ", held);
        Run(world, 2);
        for (int i = 1; i <= rises; i++)
        {
            world.DriveAt("ShoulderJ", 6 * perMinute * i / rises);
            Run(world, 0.02);
            Assert.That(world["ElbowJ"], Is.EqualTo(held).Within(Tolerance), $"at {world.Time} s");
        }

        Run(world, 1);
        Assert.That(world["ElbowJ"], Is.EqualTo(held).Within(Tolerance));
        Assert.That(world.Findings.Diagnostics, Is.Empty);
    }

    [TestCase(0.02, 1500)]
    [TestCase(0.005, 360)]
    public void DriveAt_OfTheShoulderAtOnce_MovesNoElbow(double dt, double speed)
    {
        World world = Arm(dt, 9.81, 1);
        world.DriveTo("ShoulderJ", 0);
        world.DriveTo("ElbowJ", 0);
        Run(world, 1);
        world.DriveAt("ShoulderJ", speed);
        for (int i = 0; i < 1 / dt; i++)
        {
            world.Step(dt);
            Assert.That(world["ElbowJ"], Is.Zero.Within(Tolerance), $"at {world.Time} s");
        }

        Assert.That(world.Findings.Diagnostics, Is.Empty);
    }

    /// <summary>
    /// What was left of the speed of a drive at rest, 4e-10 rad/s of rounding, was compared with a length: it never was seen to follow, and rested for ever
    /// at 13.6 degrees.
    /// </summary>
    [TestCase(1.0 / 240)]
    [TestCase(1.0 / 500)]
    [TestCase(0.02)]
    public void DriveTo_SlideAndSwingOnWhatTurns_Arrive(double dt)
    {
        const double turns = -720, slide = 0.3436, swing = 25.647;
        var turntable = new HingeJoint { Name = "Turntable", Anchor = new Vector3d(-BarLength / 2, 0, 0), Axis = new Vector3d(0.89, -0.27, 0.36) };
        var arm = new ConfigurableJoint
        {
            Name = "Arm",
            ConnectedBody = 0,
            Anchor = new Vector3d(-BarLength / 2, 0, 0),
            Axis = new Vector3d(0.74, 0.47, 0.49),
            SecondaryAxis = new Vector3d(-0.41, -0.26, 0.87),
            YMotion = ConfigurableJointMotion.Locked,
            ZMotion = ConfigurableJointMotion.Locked,
            AngularXMotion = ConfigurableJointMotion.Locked,
            AngularZMotion = ConfigurableJointMotion.Locked,
        };
        World world = Create(dt, 9.81, Bar("Base", 0.25, 0.0137, turntable), Bar("Link", 0.75, 1, arm));
        world.DriveTo("Turntable", turns);
        WorldJoint second = world.Joint("Arm");
        second.DriveTo(Coordinate.X, slide);
        second.DriveTo(Coordinate.AngularY, swing);

        Run(world, 8);

        Assert.That(world["Turntable"], Is.EqualTo(turns).Within(Tolerance));
        Assert.That(second.Coordinate(Coordinate.X), Is.EqualTo(slide).Within(1e-5));
        Assert.That(second.Coordinate(Coordinate.AngularY), Is.EqualTo(swing).Within(Tolerance));
    }

    // Two bars stretched out along X, hinged about Z.
    private static World Arm(double dt, double gravity, double forearm)
    {
        HingeJoint Hinge(string name, int? connected) => new() { Name = name, ConnectedBody = connected, Anchor = new Vector3d(-BarLength / 2, 0, 0), Axis = Vector3d.UnitZ };
        return Create(dt, gravity, Bar("Shoulder", 0.25, 1, Hinge("ShoulderJ", null)), Bar("Elbow", 0.75, forearm, Hinge("ElbowJ", 0)));
    }

    private static World Create(double dt, double gravity, params GameObject[] bars)
    {
        var physics = new Physics { Gravity = new Vector3d(0, -gravity, 0), FixedTimestep = dt, DefaultMaxAngularSpeed = 1e4 };
        return World.Create(SmallScene.Validate(new SceneDocument { Version = "1.1", Physics = physics, GameObjects = bars.ToList() }), SolverKind.Exact);
    }

    private static GameObject Bar(string id, double x, double mass, Component joint)
    {
        const double thickness = 0.04;
        double along = mass * thickness * thickness / 6, across = mass * (BarLength * BarLength + thickness * thickness) / 12;
        var body = new Rigidbody { Mass = mass, AngularDamping = 0, MaxAngularVelocity = 1e4, InertiaTensor = new Vector3d(along, across, across) };
        return new GameObject { Id = id, Name = id, Transform = new Transform { LocalPosition = new Vector3d(x, 0, 0) }, Components = new[] { body, joint } };
    }

    private static void Run(World world, double seconds) => world.Run(seconds, step: world.Scene.Document.Physics.FixedTimestep);
}
