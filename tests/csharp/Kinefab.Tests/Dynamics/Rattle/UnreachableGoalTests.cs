using System;
using System.IO;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Tests.Kinematics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>
/// Goals that a mechanism cannot reach, as where millimetres were given for metres: it goes as far as it can and stays there. A slider-crank asked for
/// 66 m had its crank thrown round at 100,000 degrees a second, 1,000 parts a step and stops; one asked for 0.3 m never came to rest.
/// </summary>
internal sealed class UnreachableGoalTests
{
    // Of crank and rod in line.
    private const double Farthest = 0.1119;
    private const double Nearest = -0.8983;
    private const double Dt = 0.02;

    [TestCase(0.3, Farthest)]
    [TestCase(1, Farthest)]
    [TestCase(10, Farthest)]
    [TestCase(66.19, Farthest)]
    [TestCase(-1, Nearest)]
    [TestCase(-3, Nearest)]
    [TestCase(-36, Nearest)]
    [TestCase(-40, Nearest)]
    [TestCase(-43, Nearest)]
    public void DriveTo_BeyondADeadPoint_StaysAtItAndIsNamed(double goal, double expected)
    {
        World world = Fixture("M08");
        WorldJoint slider = world.Joints[3];
        slider.DriveTo(Coordinate.X, goal);
        double most = 0, fastest = 0;
        for (int i = 0; i < 150; i++)
        {
            double before = world.SubstepWork;
            world.Step(Dt);
            most = Math.Max(most, (world.SubstepWork - before) / world.Joints.Count);
            fastest = Math.Max(fastest, world.Bodies.Max(body => body.AngularVelocity.Length));
        }

        Assert.That(slider.Coordinate(Coordinate.X), Is.EqualTo(expected).Within(5e-3));
        Assert.That(world.Findings.Diagnostics.Single(found => found.Code == DiagnosticCodes.DriveStalled).Message, Does.Contain("slider (drive)"));
        Assert.That(world.Stops, Is.Zero);
        Assert.That(most, Is.LessThanOrEqualTo(300));
        Assert.That(world.KineticEnergy, Is.LessThanOrEqualTo(5));
        Assert.That(fastest, Is.LessThanOrEqualTo(500), "rad/s");
    }

    [Test]
    public void DriveTo_BackWithinReach_ArrivesAtOnce()
    {
        World world = Fixture("M08");
        WorldJoint slider = world.Joints[3];
        slider.DriveTo(Coordinate.X, 2);
        Run(world, 100);
        slider.DriveTo(Coordinate.X, -0.2);
        Run(world, 75);
        Assert.That(slider.Coordinate(Coordinate.X), Is.EqualTo(-0.2).Within(1e-6));
    }

    /// <summary>Drives that a gear sets against each other do not fight.</summary>
    [Test]
    public void DriveTo_GoalsThatGearsSetAgainstEachOther_AreNamedAtThePriceOfAStep()
    {
        World world = Fixture("M27");
        WorldJoint[] driven = world.Joints.Where(joint => joint.FreeCoordinates.Contains(Coordinate.Angle)).ToArray();
        driven[0].DriveTo(Coordinate.Angle, 37);
        driven[1].DriveTo(Coordinate.Angle, -80);
        driven[2].DriveTo(Coordinate.Angle, 114);
        Run(world, 100);
        Assert.That(world.Stops, Is.Zero);
        Assert.That(world.SubstepWork / 100, Is.LessThanOrEqualTo(2 * world.Joints.Count));
        Assert.That(world.Findings.Diagnostics.Select(found => found.Code).Distinct(), Is.EqualTo(new[] { DiagnosticCodes.DriveStalled }));
    }

    /// <summary>A mechanism of the fixtures, in the exact solver.</summary>
    public static World Fixture(string name) =>
        World.Create(ValidScene.Load(Path.Combine(Scenario.Folder, "..", "..", "fixtures", "mechanisms", name + ".kinefab")), SolverKind.Exact);

    private static void Run(World world, int steps)
    {
        for (int i = 0; i < steps; i++)
        {
            world.Step(Dt);
        }
    }
}
