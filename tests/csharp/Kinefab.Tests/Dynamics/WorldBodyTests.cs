using System;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>What is read from and written to the bodies of a running world, in closed form; the joint leaves all free.</summary>
public sealed class WorldBodyTests
{
    [Test]
    public void Pose_Set_TeleportsAndKeepsTheVelocities()
    {
        WorldBody body = Free(new Rigidbody { AngularDamping = 0, CenterOfMass = new Vector3d(0.1, 0.2, 0.3) }, out World world);
        body.LinearVelocity = new Vector3d(1, 2, 3);
        var place = new Pose(new Vector3d(5, 6, 7), Quaterniond.AxisAngle(Vector3d.UnitZ, 0.4));

        body.Pose = place;
        Assert.That((body.Pose.Position - place.Position).Length, Is.LessThan(1e-14));
        Assert.That((body.CenterOfMass - place.Point(new Vector3d(0.1, 0.2, 0.3))).Length, Is.LessThan(1e-14));
        SmallScene.Run(world, 1);

        Assert.That((body.Pose.Position - place.Position - new Vector3d(1, 2, 3)).Length, Is.LessThan(1e-12));
    }

    [Test]
    public void Drift_JointPulledApart_IsInMetresAndDegrees()
    {
        World world = SmallScene.Create(new FixedJoint());
        WorldBody body = world.Bodies[0];

        body.Pose = new Pose(body.Pose.Position + new Vector3d(0, 0.03, 0.04), body.Pose.Rotation * Quaterniond.AxisAngle(Vector3d.UnitY, 2 * Math.PI / 180));

        Assert.That(world.Joints[0].Drift.Distance, Is.EqualTo(0.05).Within(1e-12));
        Assert.That(world.Joints[0].Drift.Angle, Is.EqualTo(2).Within(1e-3));
    }

    [Test]
    public void AddForceAtPosition_OneStep_GivesForceAndMoment()
    {
        WorldBody body = Free(new Rigidbody { Mass = 4, AngularDamping = 0, InertiaTensor = new Vector3d(2, 2, 2) }, out World world);
        var arm = new Vector3d(0.5, 0, 0);
        var force = new Vector3d(0, 8, 0);

        body.AddForceAtPosition(force, body.CenterOfMass + arm);
        world.Step(0.1);
        world.Step(0.1);

        // F dt / m, and r x F dt / I; the second step finds the force used up.
        Assert.That((body.LinearVelocity - new Vector3d(0, 0.2, 0)).Length, Is.LessThan(1e-14));
        Assert.That((body.AngularVelocity - new Vector3d(0, 0, 0.2)).Length, Is.LessThan(1e-14));
    }

    [TestCase(null, 7)]
    [TestCase(3.0, 3)]
    public void MaxAngularVelocity_FasterBody_IsHeldToItsOwnOrTheProjects(double? own, double expected)
    {
        WorldBody body = Free(new Rigidbody { AngularDamping = 0, MaxAngularVelocity = own }, out World world);
        body.AngularVelocity = new Vector3d(0, 12, -9);

        world.Step(0.02);

        Assert.That((body.AngularVelocity - new Vector3d(0, 0.8, -0.6) * expected).Length, Is.LessThan(1e-12));
    }

    [Test]
    public void Damping_OneStep_TakesItsShare()
    {
        WorldBody body = Free(new Rigidbody { LinearDamping = 3, AngularDamping = 5 }, out World world);
        body.LinearVelocity = Vector3d.UnitX;
        body.AngularVelocity = Vector3d.UnitY;

        world.Step(0.02);

        Assert.That(body.LinearVelocity.X, Is.EqualTo(1 - 3 * 0.02).Within(1e-14));
        Assert.That(body.AngularVelocity.Y, Is.EqualTo(1 - 5 * 0.02).Within(1e-14));
    }

    [Test]
    public void Gravity_Set_ActsFromTheNextStepAndCountsInTheEnergy()
    {
        WorldBody body = Free(new Rigidbody { Mass = 2, AngularDamping = 0 }, out World world);
        world.Gravity = new Vector3d(0, 0, -5);

        world.Step(0.1);

        Assert.That((body.LinearVelocity - new Vector3d(0, 0, -0.5)).Length, Is.LessThan(1e-14));
        Assert.That(world.KineticEnergy, Is.EqualTo(0.25).Within(1e-14));
        Assert.That(world.PotentialEnergy, Is.EqualTo(2 * 5 * body.CenterOfMass.Z).Within(1e-12));
        Assert.That(world.Time, Is.EqualTo(0.1));
    }

    private static WorldBody Free(Rigidbody settings, out World world)
    {
        world = SmallScene.Create(new ConfigurableJoint(), settings);
        return world.Bodies[0];
    }

    [TestCase(double.NaN)]
    [TestCase(double.NegativeInfinity)]
    public void Setters_NoNumber_Throw(double value)
    {
        World world = SmallScene.Create(new HingeJoint());
        WorldBody body = world.Bodies[0];
        var wrong = new Vector3d(0, value, 0);
        Assert.That(() => body.LinearVelocity = wrong, Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => body.AngularVelocity = wrong, Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => body.AddForce(wrong), Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => body.AddTorque(wrong), Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => body.AddForceAtPosition(Vector3d.UnitX, wrong), Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => body.Pose = new Pose(wrong, Quaterniond.Identity), Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => body.Pose = new Pose(Vector3d.Zero, new Quaterniond(0, 0, value, 1)), Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => body.KinematicTarget = default, Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => world.Gravity = wrong, Throws.InstanceOf<ArgumentOutOfRangeException>());
    }

    [Test]
    public void Pose_RotationOfAnotherLength_IsNormalised()
    {
        WorldBody body = SmallScene.Create(new HingeJoint()).Bodies[0];
        body.Pose = new Pose(Vector3d.Zero, new Quaterniond(0, 3, 0, 4));
        Assert.That((body.Pose.Rotation * new Quaterniond(0, 0.6, 0, 0.8).Conjugate()).Vector.Length, Is.LessThanOrEqualTo(1e-12));
        Assert.That(body.Pose.Rotation.LengthSquared, Is.EqualTo(1).Within(1e-12));
    }

    [TestCase(ConfigurableJointMotion.Locked, ConfigurableJointMotion.Locked, ConfigurableJointMotion.Locked, 0)]
    [TestCase(ConfigurableJointMotion.Free, ConfigurableJointMotion.Locked, ConfigurableJointMotion.Locked, 1)]
    [TestCase(ConfigurableJointMotion.Free, ConfigurableJointMotion.Locked, ConfigurableJointMotion.Free, 1)]
    [TestCase(ConfigurableJointMotion.Free, ConfigurableJointMotion.Free, ConfigurableJointMotion.Locked, 2)]
    public void Drift_OfALockedAngle_IsTheAngle(ConfigurableJointMotion x, ConfigurableJointMotion y, ConfigurableJointMotion z, int axis)
    {
        foreach (double degrees in new[] { 0.5, -25, 60, 80 })
        {
            World world = SmallScene.Create(new ConfigurableJoint { AngularXMotion = x, AngularYMotion = y, AngularZMotion = z });
            var about = new Vector3d(axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0);

            world.Bodies[0].Pose = new Pose(SmallScene.OwnPose.Position, SmallScene.OwnPose.Rotation * Quaterniond.AxisAngle(about, degrees * System.Math.PI / 180));

            Assert.That(world.Joints[0].Drift.Angle, Is.EqualTo(System.Math.Abs(degrees)).Within(1e-9));
        }
    }
}
