using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>A wheel on a spring far too stiff for the step: without its answer to a torque's second half it shows h T / (2 I) for ever.</summary>
internal sealed class SpringAnswerTests
{
    private const double Dt = 1.0 / 60;
    private const double Torque = 5;
    private const double Inertia = 2;
    private const double Stiffness = 1e5;

    [Test]
    public void Step_UnderTorque_SagsByTorqueOverStiffnessAndShowsNoSpeed()
    {
        MultibodySystem wheel = Wheel();
        Settle(wheel, new RattleSolver(wheel));
        Assert.That(((RevoluteJoint)wheel.Joints[0]).Angle(Pose.Identity, wheel.Bodies.Poses[0]), Is.EqualTo(Torque / Stiffness).Within(1e-9));
        Assert.That(wheel.Bodies.AngularVelocities[0].Z, Is.EqualTo(0).Within(0.01 * Dt * Torque / (2 * Inertia)));
    }

    // The body has another speed inside than it shows; what a program writes is neither.
    [Test]
    public void Step_AfterAVelocityWasWritten_StartsWithThatVelocity()
    {
        MultibodySystem wheel = Wheel();
        var solver = new RattleSolver(wheel);
        Settle(wheel, solver);
        MultibodySystem other = Wheel();
        other.Bodies.Poses[0] = wheel.Bodies.Poses[0];
        wheel.Bodies.AngularVelocities[0] = new Vector3d(0, 0, 0.3);
        other.Bodies.AngularVelocities[0] = new Vector3d(0, 0, 0.3);
        solver.Step(Dt);
        new RattleSolver(other).Step(Dt);
        Assert.That((wheel.Bodies.Poses[0].Rotation.Vector - other.Bodies.Poses[0].Rotation.Vector).Length, Is.LessThan(1e-9));
        Assert.That((wheel.Bodies.AngularVelocities[0] - other.Bodies.AngularVelocities[0]).Length, Is.LessThan(1e-7));
    }

    private static MultibodySystem Wheel() =>
        LawScenes.Wheel(h => h.Spring = new DriveModel { Stiffness = Stiffness, Damping = 1e3, ForceLimit = double.PositiveInfinity });

    private static void Settle(MultibodySystem wheel, RattleSolver solver)
    {
        for (int i = 0; i < 180; i++)
        {
            wheel.Bodies.Torques[0] = new Vector3d(0, 0, Torque);
            solver.Step(Dt);
        }
    }
}
