using System;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;
using static Kinefab.Tests.Dynamics.Rattle.LawScenes;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Springs, dampers and drives alone, against closed forms: periods, rests, sags and force limits.</summary>
internal sealed class SpringLawTests
{
    [Test]
    public void HingeSpring_Released_SwingsWithItsPeriod()
    {
        const double k = 8;
        MultibodySystem m = Wheel(h =>
        {
            h.Spring = new DriveModel { Stiffness = k, ForceLimit = double.PositiveInfinity };
            h.SpringTarget = 0.7;
        });
        Run(m, 3, 1e-3);
        Assert.That(Angle(m), Is.EqualTo(0.7 - 0.7 * Math.Cos(Math.Sqrt(k / 2) * 3)).Within(1e-5));
    }

    [Test]
    public void HingeSpring_WithDamper_RestsAtItsTarget()
    {
        MultibodySystem m = Wheel(h =>
        {
            h.Spring = new DriveModel { Stiffness = 1e5, Damping = 1e3, ForceLimit = double.PositiveInfinity };
            h.SpringTarget = -0.4;
        });
        Run(m, 5);
        Assert.That(Angle(m), Is.EqualTo(-0.4).Within(1e-9));
    }

    [Test]
    public void Damper_Alone_LetsTheSpeedDecayExponentially()
    {
        MultibodySystem m = Wheel(h => h.Spring = new DriveModel { Damping = 3, ForceLimit = double.PositiveInfinity }, 2);
        Run(m, 1, 1e-3);
        Assert.That(Speed(m), Is.EqualTo(2 * Math.Exp(-3.0 / 2)).Within(1e-6));
    }

    [TestCase(2.0)]
    [TestCase(50.0)]
    public void AccelerationDrive_AnyMass_SameMotion(double mass)
    {
        MultibodySystem m = Slider(j => j.DriveX = new DriveModel { Stiffness = 9, ForceLimit = double.PositiveInfinity, IsAcceleration = true }, mass);
        ((D6Joint)m.Joints[0]).DrivePose = new Pose(new Vector3d(0.3, 0, 0), Quaterniond.Identity);
        Run(m, 1, 1e-3);
        Assert.That(m.Bodies.Poses[0].Position.X, Is.EqualTo(0.3 - 0.3 * Math.Cos(3)).Within(1e-5));
    }

    [Test]
    public void Drive_ClampedForce_AcceleratesEvenly()
    {
        MultibodySystem m = Slider(j => j.DriveX = new DriveModel { Stiffness = 1e6, ForceLimit = 4 }, 2);
        ((D6Joint)m.Joints[0]).DrivePose = new Pose(new Vector3d(100, 0, 0), Quaterniond.Identity);
        Run(m, 1);
        Assert.That(m.Bodies.LinearVelocities[0].X, Is.EqualTo(2).Within(1e-9));
    }

    [Test]
    public void Drive_UnderGravity_SagsByWeightOverStiffness()
    {
        MultibodySystem m = Slider(j => j.DriveX = new DriveModel { Stiffness = 200, Damping = 30, ForceLimit = double.PositiveInfinity }, 2);
        m.Gravity = new Vector3d(-9.81, 0, 0);
        Run(m, 10);
        Assert.That(m.Bodies.Poses[0].Position.X, Is.EqualTo(-2 * 9.81 / 200).Within(1e-8));
    }

    [TestCase(true)]
    [TestCase(false)]
    public void AngularDrive_SlerpOrTwistAndSwing_RestsAtItsGoal(bool isSlerp)
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int body = b.Body(Vector3d.Zero, Quaterniond.Identity, 1, new Vector3d(0.2, 0.3, 0.4));
        var drive = new DriveModel { Stiffness = 40, Damping = 8, ForceLimit = double.PositiveInfinity };
        var goal = Quaterniond.AxisAngle(new Vector3d(0.6, 0, 0.8), 0.5);
        b.Add(
            new D6Joint
            {
                Twist = AxisMotion.Free, Swing1 = AxisMotion.Free, Swing2 = AxisMotion.Free, DrivePose = new Pose(Vector3d.Zero, goal),
                DriveSlerp = isSlerp ? drive : default, DriveTwist = isSlerp ? default : drive, DriveSwing = isSlerp ? default : drive,
            },
            JointModel.World,
            body,
            Pose.Identity);
        MultibodySystem m = b.Build();
        Run(m, 10);
        Assert.That((m.Bodies.Poses[0].Rotation * goal.Conjugate()).Vector.Length, Is.LessThanOrEqualTo(1e-7));
    }

    [TestCase(0, false)]
    [TestCase(0, true)]
    [TestCase(1, false)]
    [TestCase(1, true)]
    public void TwistAndSwingDrives_WithoutDamper_KeepTheirEnergy(int axis, bool isBall)
    {
        const double k = 100, way = 1.5, dt = 0.02;
        const int span = 100;
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int body = b.Body(Vector3d.Zero, Quaterniond.Identity, 1, new Vector3d(1, 1, 1));
        var drive = new DriveModel { Stiffness = k, ForceLimit = double.PositiveInfinity };
        b.Add(
            new D6Joint
            {
                Twist = isBall || axis == 0 ? AxisMotion.Free : AxisMotion.Locked,
                Swing1 = isBall || axis == 1 ? AxisMotion.Free : AxisMotion.Locked,
                Swing2 = isBall ? AxisMotion.Free : AxisMotion.Locked,
                DrivePose = new Pose(Vector3d.Zero, Quaterniond.AxisAngle(axis == 0 ? Vector3d.UnitX : Vector3d.UnitY, way)),
                DriveTwist = drive, DriveSwing = drive,
            },
            JointModel.World,
            body,
            Pose.Identity);
        MultibodySystem m = b.Build();

        // Torques 2 k sin(left / 2) and k sin(left).
        double held = axis == 0 ? 4 * k * (1 - Math.Cos(way / 2)) : k * (1 - Math.Cos(way));
        for (int i = 0; i < 5; i++)
        {
            double most = 0;
            for (int step = 0; step < span; step++)
            {
                Run(m, dt, dt);
                most = Math.Max(most, MechanismMeasures.Kinetic(m));
            }

            Assert.That(most, Is.InRange(0.99 * held, 1.001 * held), $"after {(i + 1) * span} steps");
        }
    }

    [TestCase(0.3)]
    [TestCase(0.6)]
    [TestCase(0.9)]
    public void TwistDrive_TooWeakForTheWeight_FallsAsFarAsItsForceSaysAndSwingsBack(double share)
    {
        // A bar of 1 kg and 1 m lies level on a drive whose torque is a share of its weight's: it falls until the work of both is
        // the same, m g r sin q = share m g r q.
        var b = new MechanismBuilder();
        int bar = b.Bar(Vector3d.Zero, Vector3d.UnitX, 1);
        var drive = new DriveModel { Stiffness = 1e5, ForceLimit = share * 9.81 * 0.5 };
        b.Add(new D6Joint { Twist = AxisMotion.Free, DriveTwist = drive }, JointModel.World, bar, Vector3d.Zero, Vector3d.UnitZ);
        MultibodySystem m = b.Build();
        double lowest = 0;
        double back = 0;
        void Note()
        {
            Vector3d along = m.Bodies.Poses[bar].Rotation * Vector3d.UnitX;
            double angle = Math.Atan2(-along.Y, along.X);
            back = angle > lowest ? angle : Math.Min(back, angle);
            lowest = Math.Max(lowest, angle);
        }

        Run(m, 4, before: Note);
        Assert.That(Math.Sin(lowest) / lowest, Is.EqualTo(share).Within(5e-3));
        Assert.That(back, Is.LessThan(0.1));
        Assert.That(m.Stops, Is.Zero);
    }
}
