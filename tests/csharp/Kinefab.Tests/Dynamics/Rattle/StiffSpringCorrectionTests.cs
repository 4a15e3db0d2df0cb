using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>A wheel on a spring far too stiff for the step: without its answer to a torque's second half it shows h T / (2 I) for ever.</summary>
internal sealed class StiffSpringCorrectionTests
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

    // Too stiff to follow, the spring gave more than half of what its limit allows before the drift: 0.2 to 0.4 % of way in a second.
    [TestCase(2e4, 240)]
    [TestCase(1e5, 240)]
    [TestCase(1e7, 60)]
    public void Step_AtTheForceLimitOfAStiffDrive_MovesAsByThatForce(double stiffness, int steps)
    {
        const double force = 3, mass = 1.5;
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int block = b.Bar(new Vector3d(-0.1, 0, 0), new Vector3d(0.1, 0, 0), mass);
        D6Joint rail = b.Add(new D6Joint { X = AxisMotion.Free }, JointModel.World, block, Vector3d.Zero, Vector3d.UnitX);
        rail.DriveX = new DriveModel { Stiffness = stiffness, ForceLimit = force };
        rail.DrivePose = new Pose(new Vector3d(100, 0, 0), Quaterniond.Identity);
        MultibodySystem m = b.Build();
        var solver = new RattleSolver(m);
        for (int i = 0; i < steps; i++)
        {
            solver.Step(1.0 / steps);
        }

        Assert.That(m.Bodies.Poses[block].Position.X, Is.EqualTo(force / mass / 2).Within(1e-9));
        Assert.That(m.Bodies.LinearVelocities[block].X, Is.EqualTo(force / mass).Within(1e-9));
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
