using System;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>A ball whose twist is driven to a goal while it swings: the drive acts on the twist, and the swing is its own.</summary>
internal sealed class BallGoalTests
{
    // By the gradient of what was prescribed, which falls as the joint swings too, the drive turned it over: 250 to 370,000 J.
    [Test]
    public void DriveTo_BeyondTheLimitOfATwist_ThrowsNoBallAbout([Values(0.02, 0.005)] double step, [Values] bool hasCone, [Values(1, -1)] int side)
    {
        ConfigurableJointMotion swing = hasCone ? ConfigurableJointMotion.Limited : ConfigurableJointMotion.Free;
        World world = Ball(ConfigurableJointMotion.Limited, swing, new Vector3d(-0.1, -0.15, 0));
        world.Bodies[0].AngularVelocity = SmallScene.OwnPose.Rotation * new Vector3d(0, 2, 1);
        world.Bodies[0].LinearVelocity = Vector3d.Cross(world.Bodies[0].AngularVelocity, world.Bodies[0].CenterOfMass - Pivot);
        var joint = (WorldConfigurableJoint)world.Joints[0];
        joint.DriveTo(Coordinate.AngularX, side * 34);

        double most = 0, farthest = 0;
        world.Run(1, step: step, until: w =>
        {
            most = Math.Max(most, w.KineticEnergy);
            farthest = Math.Max(farthest, Math.Abs(joint.Coordinate(Coordinate.AngularX)));
            return false;
        });

        // The start's and the drive's own: 34 degrees in a tenth of a second, of 0.0325 kg m^2, come to 0.6 J.
        Assert.That(world.Stops, Is.Zero);
        Assert.That(most, Is.LessThan(3));
        Assert.That(farthest, Is.InRange(19.9, 20 + 1e-5));
    }

    [Test]
    public void DriveTo_OfATwistThatSwings_HasItsWayFallAsPrescribed()
    {
        const double step = 0.01, share = step / 0.1;
        World world = Ball(ConfigurableJointMotion.Free, ConfigurableJointMotion.Free, Vector3d.Zero);
        world.Bodies[0].AngularVelocity = SmallScene.OwnPose.Rotation * new Vector3d(0, 5, 3);
        var joint = (WorldConfigurableJoint)world.Joints[0];
        joint.DriveTo(Coordinate.AngularX, 40);
        double left = 40;
        for (int i = 0; i < 40; i++)
        {
            world.Step(step);
            left /= 1 + share + share * share / 2;

            Assert.That(40 - joint.Coordinate(Coordinate.AngularX), Is.EqualTo(left).Within(1e-6), $"after step {i + 1}, swung by {joint.Coordinate(Coordinate.AngularY)} degrees");
        }

        Assert.That(Math.Abs(joint.Coordinate(Coordinate.AngularY)), Is.GreaterThan(40));
    }

    private static Vector3d Pivot => SmallScene.OwnPose.Position;

    private static World Ball(ConfigurableJointMotion twist, ConfigurableJointMotion swing, Vector3d away)
    {
        const ConfigurableJointMotion locked = ConfigurableJointMotion.Locked;
        var joint = new ConfigurableJoint
        {
            XMotion = locked, YMotion = locked, ZMotion = locked, AngularXMotion = twist, AngularYMotion = swing, AngularZMotion = swing,
            LowAngularXLimit = new SoftJointLimit { Limit = -20 }, HighAngularXLimit = new SoftJointLimit { Limit = 20 },
            AngularYLimit = new SoftJointLimit { Limit = 40 }, AngularZLimit = new SoftJointLimit { Limit = 20 },
        };
        var body = new Rigidbody { CenterOfMass = -away, InertiaTensor = new Vector3d(0.01, 0.01, 0.01), AngularDamping = 0, MaxAngularVelocity = 1e4, UseGravity = false };
        return SmallScene.Create(joint, body, solver: SolverKind.Exact);
    }
}
