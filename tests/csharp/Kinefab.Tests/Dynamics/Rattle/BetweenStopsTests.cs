using System;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>A body that flies to and fro between two stops without any force, against its closed form: straight lines, and a share of the speed at each blow.</summary>
internal sealed class BetweenStopsTests
{
    /// <summary>A slide's one limit holds at both ends. It begins in the middle, where it has no row, and strikes several times in a step.</summary>
    [TestCase(0.9, 0.01, 5e-4, 12)]
    [TestCase(0.9, 0.02, 5e-4, 12)]
    [TestCase(0.3, 0.02, 5e-4, 12)]
    [TestCase(0.6, 0.02, 1e-3, 12)]
    public void Slide_InANarrowGap_IsThrownToAndFro(double bounciness, double dt, double gap, int steps) => Fly(isSlide: true, bounciness, dt, gap, steps);

    /// <summary>It comes to its stop as the step ends, to the bit or nearly, and stands there for no step.</summary>
    [Test]
    public void Joint_ReachingItsStopAsAStepEnds_IsThrownBackThere([Values] bool isSlide, [Values(1.0, 0.5)] double bounciness) => Fly(isSlide, bounciness, 0.02, 0.5, 60);

    private static void Fly(bool isSlide, double bounciness, double dt, double gap, int steps)
    {
        World world = SmallScene.Create(isSlide ? Slide(gap, bounciness) : Hinge(gap, bounciness), solver: SolverKind.Exact);
        WorldBody body = world.Bodies[0];
        Vector3d axis = SmallScene.OwnPose.Rotation * Vector3d.UnitX;
        body.LinearVelocity = isSlide ? axis : Vector3d.Zero;
        body.AngularVelocity = isSlide ? Vector3d.Zero : axis;
        double place = 0, speed = 1;
        for (int i = 1; i <= steps; i++)
        {
            world.Step(dt);
            for (double left = dt; left > 0;)
            {
                double until = ((speed > 0 ? gap : -gap) - place) / speed;
                place += speed * Math.Min(left, until);
                speed *= until < left ? -bounciness : 1;
                left -= Math.Min(left, until);
            }

            double at = isSlide ? SmallScene.Way(world).X : -world.Joints[0].Coordinate(Coordinate.Angle) * Math.PI / 180;
            Assert.That(Math.Abs(at), Is.EqualTo(Math.Abs(place)).Within(1e-3 * gap), $"step {i}");
        }
    }

    private static ConfigurableJoint Slide(double gap, double bounciness) => new()
    {
        Axis = Vector3d.UnitX, SecondaryAxis = Vector3d.UnitY, XMotion = ConfigurableJointMotion.Limited, YMotion = ConfigurableJointMotion.Locked,
        ZMotion = ConfigurableJointMotion.Locked, AngularXMotion = ConfigurableJointMotion.Locked, AngularYMotion = ConfigurableJointMotion.Locked,
        AngularZMotion = ConfigurableJointMotion.Locked, LinearLimit = new SoftJointLimit { Limit = gap, Bounciness = bounciness },
    };

    private static HingeJoint Hinge(double gap, double bounciness) => new()
    {
        Axis = Vector3d.UnitX, UseLimits = true, Limits = new JointLimits { Min = -gap * 180 / Math.PI, Max = gap * 180 / Math.PI, Bounciness = bounciness },
    };
}
