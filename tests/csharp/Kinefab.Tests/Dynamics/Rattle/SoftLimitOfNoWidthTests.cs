using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Linear motions Limited to a radius of 0 with a limit spring, as Unity's ConfigurableJoint has them unless a limit is set: a spring to a point.</summary>
public sealed class SoftLimitOfNoWidthTests
{
    private static readonly Rigidbody Body = new()
    {
        Mass = 2,
        InertiaTensor = new Vector3d(0.1, 0.12, 0.08),
        CenterOfMass = new Vector3d(0.2, 0, 0),
        AngularDamping = 0,
        MaxAngularVelocity = 1000,
    };

    [TestCase(1e5)]
    [TestCase(1e8)]
    public void BodyThatSpinsAboutThePoint_GoesOnSpinning(double spring)
    {
        World world = SmallScene.Create(Joint(spring, 20), Body, solver: SolverKind.Exact);
        Vector3d spin = SmallScene.OwnPose.Rotation * new Vector3d(0, 0, 3);
        world.Bodies[0].AngularVelocity = spin;
        world.Bodies[0].LinearVelocity = Vector3d.Cross(spin, SmallScene.OwnPose.Rotation * Body.CenterOfMass);
        double energy = world.KineticEnergy;

        for (int i = 0; i < 100; i++)
        {
            world.Step(0.02);
        }

        Assert.That(world.KineticEnergy, Is.EqualTo(energy).Within(2e-3 * energy), "The spring draws across the motion and holds next to nothing.");
        Assert.That(world.Stops, Is.Zero);
    }

    [TestCase(0.9, true)]
    [TestCase(1.1, false)]
    public void HangingBody_SinksByItsWeightOverTheSpring_WhichTheJointBears(double share, bool breaks)
    {
        const double weight = 2 * 9.81, spring = 1e4;
        ConfigurableJoint joint = Joint(spring, 400) with { BreakForce = share * weight };
        World world = SmallScene.Create(joint, Body with { CenterOfMass = Vector3d.Zero }, solver: SolverKind.Exact);
        world.Gravity = new Vector3d(0, -9.81, 0);

        for (int i = 0; i < 400; i++)
        {
            world.Step(0.01);
        }

        Assert.That(world.Joints[0].IsBroken, Is.EqualTo(breaks));
        if (!breaks)
        {
            Assert.That(SmallScene.OwnPose.Position.Y - world.Bodies[0].Pose.Position.Y, Is.EqualTo(weight / spring).Within(1e-6));
            Assert.That(world.Joints[0].CurrentForce.Length, Is.EqualTo(weight).Within(1e-3));
        }
    }

    private static ConfigurableJoint Joint(double spring, double damper) => new()
    {
        XMotion = ConfigurableJointMotion.Limited,
        YMotion = ConfigurableJointMotion.Limited,
        ZMotion = ConfigurableJointMotion.Limited,
        LinearLimitSpring = new SoftJointLimitSpring { Spring = spring, Damper = damper },
    };
}
