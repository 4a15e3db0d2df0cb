using System;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>
/// Parallelograms that begin lying flat, where their two branches of motion meet: J allows more speeds there than any motion has, and what the loop takes of
/// these is lost whatever the step.
/// </summary>
internal sealed class SingularPoseTests
{
    private const double Dt = 0.02;
    private const int Steps = 20;

    [TestCase("M05")]
    [TestCase("M39")]
    public void Step_FromFlatPose_TakesFewPartsAndFallsAsWithFinerSteps(string name)
    {
        World coarse = UnreachableGoalTests.Fixture(name);
        int most = 0;
        for (int i = 0; i < Steps; i++)
        {
            double before = coarse.SubstepWork;
            coarse.Step(Dt);
            most = Math.Max(most, (int)((coarse.SubstepWork - before) / coarse.Joints.Count));
        }

        World fine = UnreachableGoalTests.Fixture(name);
        for (int i = 0; i < Steps * 64; i++)
        {
            fine.Step(Dt / 64);
        }

        Assert.That(most, Is.LessThanOrEqualTo(100));
        Assert.That(coarse.Stops + fine.Stops, Is.Zero);
        for (int i = 0; i < coarse.Joints.Count; i++)
        {
            double expected = fine.Joints[i].Coordinate(Coordinate.Angle);
            Assert.That(coarse.Joints[i].Coordinate(Coordinate.Angle), Is.EqualTo(expected).Within(10).Percent, coarse.Joints[i].Id);
        }
    }

    // Closing the last tolerance C of such a pose takes a way of the order of its root: a gain of potential energy that shorter parts do not lessen.
    [TestCase(1 / 30.0)]
    [TestCase(0.0333)]
    public void Step_OfAThirtiethFromAFlatPose_DoesNotStop(double dt)
    {
        World world = UnreachableGoalTests.Fixture("M05");
        for (int i = 0; i < 60; i++)
        {
            world.Step(dt);
        }

        Assert.That(world.Stops, Is.Zero);
    }

    /// <summary>
    /// A platform on six rods that is singular in every pose sags and rattles within the tolerance of its rods, whose reactions are a thousand times its
    /// weight. What these do over a gap was taken for energy from nothing: up to 771 parts a step and, of 0.01 s, 32 stops.
    /// </summary>
    [TestCase(0.02)]
    [TestCase(1 / 60.0)]
    [TestCase(0.01)]
    [TestCase(0.005)]
    public void Step_PlatformThatIsSingularThroughout_StaysWhereItIsAndTakesFewParts(double dt)
    {
        // It moves by one freedom, along which nothing pushes.
        const double mostMoved = 5e-3;

        World world = UnreachableGoalTests.Fixture("M17");
        var start = world.Bodies.Select(body => body.Pose.Position).ToArray();
        double most = 0;
        for (int i = 0; i < 1 / dt; i++)
        {
            double before = world.SubstepWork;
            world.Step(dt);
            most = Math.Max(most, (world.SubstepWork - before) / world.Joints.Count);
        }

        Assert.That(world.Findings.Diagnostics, Is.Empty);
        Assert.That(most, Is.LessThanOrEqualTo(100));
        Assert.That(world.Joints.Max(joint => joint.Drift.Distance), Is.LessThanOrEqualTo(1e-8));
        for (int i = 0; i < start.Length; i++)
        {
            Assert.That((world.Bodies[i].Pose.Position - start[i]).Length, Is.LessThanOrEqualTo(mostMoved));
        }
    }
}
