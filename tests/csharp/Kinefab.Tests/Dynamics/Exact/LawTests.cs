using System;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Exact;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Exact;

/// <summary>Limits, drives, motors, springs, couplings and breakage against closed forms.</summary>
internal sealed class LawTests
{
    private const double Dt = 1.0 / 100;

    // A wheel of I = 2 kg m^2 about Z on a hinge whose actor 1 it is: angle and speed are those of the wheel.
    private static MultibodySystem Wheel(Action<RevoluteJoint> set, double speed = 0)
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int wheel = b.Body(new Vector3d(1, 2, 3), Quaterniond.Identity, 3, new Vector3d(1.1, 1.3, 2));
        b.Change(wheel, d =>
        {
            d.AngularVelocity = new Vector3d(0, 0, speed);
            return d;
        });
        RevoluteJoint hinge = b.Hinge(Joint.World, wheel, new Vector3d(1, 2, 3), Vector3d.UnitZ);
        set(hinge);
        return b.Build();
    }

    private static double Speed(MultibodySystem m) => m.Bodies.AngularVelocities[0].Z;

    private static double Angle(MultibodySystem m) => ((RevoluteJoint)m.Joints[0]).Angle(Pose.Identity, m.Bodies.Poses[0]);

    private static void Run(MultibodySystem m, double seconds, double dt = Dt, Action? before = null)
    {
        var solver = new ExactSolver(m);
        int steps = (int)Math.Round(seconds / dt);
        for (int i = 0; i < steps; i++)
        {
            before?.Invoke();
            solver.Step(dt);
        }
    }

    [Test]
    public void Motor_BelowItsSpeed_AcceleratesWithItsTorque()
    {
        MultibodySystem m = Wheel(h => Motor(h, 6, 4, false));
        Run(m, 1);
        Assert.That(Speed(m), Is.EqualTo(4.0 / 2 * 1).Within(1e-9));
    }

    [TestCase(0.0)]
    [TestCase(1.0)]
    public void Motor_FirstStep_ActsInFullWhereverTheBodyStands(double x)
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int wheel = b.Body(new Vector3d(x, 0, 0), Quaterniond.Identity, 3, new Vector3d(1.1, 1.3, 2));
        Motor(b.Hinge(Joint.World, wheel, new Vector3d(x, 0, 0), Vector3d.UnitZ), 6, 4, false);
        MultibodySystem m = b.Build();
        Run(m, Dt);
        Assert.That(Speed(m), Is.EqualTo(4.0 / 2 * Dt).Within(1e-12));
    }

    [Test]
    public void Motor_AtItsSpeed_HoldsItAgainstATorque()
    {
        MultibodySystem m = Wheel(h => Motor(h, 6, 40, false));
        Run(m, 3, Dt, () => m.Bodies.Torques[0] = new Vector3d(0, 0, -10));
        Assert.That(Speed(m), Is.EqualTo(6).Within(1e-8));
    }

    [TestCase(false, 6)]
    [TestCase(true, 9)]
    public void Motor_AboveItsSpeed_BrakesUnlessFreeSpin(bool freeSpin, double expected)
    {
        MultibodySystem m = Wheel(h => Motor(h, 6, 40, freeSpin), 9);
        Run(m, 1);
        Assert.That(Speed(m), Is.EqualTo(expected).Within(1e-8));
    }

    [Test]
    public void HardLimit_UnderTorque_StopsAndHolds()
    {
        MultibodySystem m = Wheel(h => Limits(h, -10, 80, default), 1);
        Run(m, 4, Dt, () => m.Bodies.Torques[0] = new Vector3d(0, 0, 0.5));
        Assert.That(Angle(m), Is.EqualTo(80 * Math.PI / 180).Within(1e-8));
        Assert.That(Speed(m), Is.EqualTo(0).Within(1e-8));
        Assert.That(m.Reactions[0].Torque.Z, Is.EqualTo(0.5).Within(1e-6));
    }

    [Test]
    public void HardLimit_MovedWhileItHolds_HoldsAtItsNewPlace()
    {
        MultibodySystem m = Wheel(h => Limits(h, -10, 80, default), 1);
        var hinge = (RevoluteJoint)m.Joints[0];
        var solver = new ExactSolver(m);
        for (int i = 0; i < 800; i++)
        {
            if (i == 400)
            {
                Limits(hinge, -10, 90, default);
            }

            m.Bodies.Torques[0] = new Vector3d(0, 0, 0.5);
            solver.Step(Dt);
            if (i == 399)
            {
                Assert.That(Angle(m), Is.EqualTo(80 * Math.PI / 180).Within(1e-8));
            }
        }

        Assert.That(Angle(m), Is.EqualTo(90 * Math.PI / 180).Within(1e-8));
        Assert.That(m.Reactions[0].Torque.Z, Is.EqualTo(0.5).Within(1e-6));
    }

    [Test]
    public void MotorThenSpring_SwitchedWhileRunning_ActsAsTheSpringAlone()
    {
        MultibodySystem m = Wheel(h => Motor(h, 6, 1000, false));
        var hinge = (RevoluteJoint)m.Joints[0];
        Run(m, 0.1);
        var solver = new ExactSolver(m);
        solver.Step(Dt);
        hinge.MotorEnabled = false;
        hinge.Spring = new JointDrive { Damping = 3, ForceLimit = double.PositiveInfinity };
        for (int i = 0; i < 100; i++)
        {
            solver.Step(Dt);
        }

        Assert.That(Speed(m), Is.EqualTo(6 * Math.Exp(-3.0 / 2)).Within(1e-4));
    }

    [Test]
    public void HardLimit_OnTheOtherSide_StopsThere()
    {
        MultibodySystem m = Wheel(h => Limits(h, -10, 80, default), -1);
        Run(m, 1);
        Assert.That(Angle(m), Is.EqualTo(-10 * Math.PI / 180).Within(1e-8));
    }

    [TestCase(10, 50, 10)]
    [TestCase(-50, -10, -10)]
    public void HardLimits_BeyondThemAtTheStart_ComesBackAndStays(double lower, double upper, double expected)
    {
        // The way back within one step, at 17 rad/s, is no motion: else the wheel would fly on to the other limit.
        MultibodySystem m = Wheel(h => Limits(h, lower, upper, default));
        Run(m, 1);
        Assert.That(Angle(m), Is.EqualTo(expected * Math.PI / 180).Within(1e-8));
        Assert.That(Speed(m), Is.EqualTo(0).Within(1e-8));
    }

    [Test]
    public void HardLimits_BeyondThemOnTheWayIn_KeepTheSpeed()
    {
        MultibodySystem m = Wheel(h => Limits(h, 1, 170, default), 3);
        Run(m, 0.5);
        Assert.That(Speed(m), Is.EqualTo(3).Within(1e-8));
    }

    [Test]
    public void BouncyLimit_Hit_GivesBackItsShareOfTheSpeed()
    {
        MultibodySystem m = Wheel(h => Limits(h, -10, 80, new LimitResponse { Restitution = 0.5, BounceThreshold = 0.2 }), 2);
        Run(m, 1);
        Assert.That(Speed(m), Is.EqualTo(-1).Within(1e-8));
    }

    [Test]
    public void BouncyLimit_BelowTheThreshold_DoesNotBounce()
    {
        MultibodySystem m = Wheel(h => Limits(h, -10, 80, new LimitResponse { Restitution = 0.5, BounceThreshold = 3 }), 2);
        Run(m, 1);
        Assert.That(Speed(m), Is.EqualTo(0).Within(1e-8));
    }

    [Test]
    public void SoftLimit_UnderTorque_GivesByTorqueOverStiffness()
    {
        MultibodySystem m = Wheel(h => Limits(h, -10, 80, new LimitResponse { Stiffness = 50, Damping = 20 }), 1);
        Run(m, 20, Dt, () => m.Bodies.Torques[0] = new Vector3d(0, 0, 5));
        Assert.That(Angle(m), Is.EqualTo(80 * Math.PI / 180 + 5.0 / 50).Within(1e-7));
    }

    [Test]
    public void HingeSpring_Released_SwingsWithItsPeriod()
    {
        const double k = 8;
        MultibodySystem m = Wheel(h =>
        {
            h.Spring = new JointDrive { Stiffness = k, ForceLimit = double.PositiveInfinity };
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
            h.Spring = new JointDrive { Stiffness = 1e5, Damping = 1e3, ForceLimit = double.PositiveInfinity };
            h.SpringTarget = -0.4;
        });
        Run(m, 5);
        Assert.That(Angle(m), Is.EqualTo(-0.4).Within(1e-9));
    }

    [Test]
    public void Damper_Alone_LetsTheSpeedDecayExponentially()
    {
        MultibodySystem m = Wheel(h => h.Spring = new JointDrive { Damping = 3, ForceLimit = double.PositiveInfinity }, 2);
        Run(m, 1, 1e-3);
        Assert.That(Speed(m), Is.EqualTo(2 * Math.Exp(-3.0 / 2)).Within(1e-6));
    }

    [TestCase(2.0)]
    [TestCase(50.0)]
    public void AccelerationDrive_AnyMass_SameMotion(double mass)
    {
        MultibodySystem m = Slider(j => j.DriveX = new JointDrive { Stiffness = 9, ForceLimit = double.PositiveInfinity, IsAcceleration = true }, mass);
        ((D6Joint)m.Joints[0]).DrivePose = new Pose(new Vector3d(0.3, 0, 0), Quaterniond.Identity);
        Run(m, 1, 1e-3);
        Assert.That(m.Bodies.Poses[0].Position.X, Is.EqualTo(0.3 - 0.3 * Math.Cos(3)).Within(1e-5));
    }

    [Test]
    public void Drive_ClampedForce_AcceleratesEvenly()
    {
        MultibodySystem m = Slider(j => j.DriveX = new JointDrive { Stiffness = 1e6, ForceLimit = 4 }, 2);
        ((D6Joint)m.Joints[0]).DrivePose = new Pose(new Vector3d(100, 0, 0), Quaterniond.Identity);
        Run(m, 1);
        Assert.That(m.Bodies.LinearVelocities[0].X, Is.EqualTo(2).Within(1e-9));
    }

    [Test]
    public void Drive_UnderGravity_SagsByWeightOverStiffness()
    {
        MultibodySystem m = Slider(j => j.DriveX = new JointDrive { Stiffness = 200, Damping = 30, ForceLimit = double.PositiveInfinity }, 2);
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
        var drive = new JointDrive { Stiffness = 40, Damping = 8, ForceLimit = double.PositiveInfinity };
        var goal = Quaterniond.AxisAngle(new Vector3d(0.6, 0, 0.8), 0.5);
        b.Add(
            new D6Joint
            {
                Twist = AxisMotion.Free, Swing1 = AxisMotion.Free, Swing2 = AxisMotion.Free, DrivePose = new Pose(Vector3d.Zero, goal),
                DriveSlerp = isSlerp ? drive : default, DriveTwist = isSlerp ? default : drive, DriveSwing = isSlerp ? default : drive,
            },
            Joint.World,
            body,
            Pose.Identity);
        MultibodySystem m = b.Build();
        Run(m, 10);
        Assert.That((m.Bodies.Poses[0].Rotation * goal.Conjugate()).Vector.Length, Is.LessThanOrEqualTo(1e-7));
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
        var drive = new JointDrive { Stiffness = 1e5, ForceLimit = share * 9.81 * 0.5 };
        b.Add(new D6Joint { Twist = AxisMotion.Free, DriveTwist = drive }, Joint.World, bar, Vector3d.Zero, Vector3d.UnitZ);
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

    [Test]
    public void BallLimit_BodyOnIt_HangsAtItsRadius()
    {
        var b = new MechanismBuilder();
        BodyDefinition d = BodyDefinition.Default;
        d.LinearDamping = 2;
        d.AngularDamping = 2;
        int body = b.Body(d);
        var joint = new D6Joint
        {
            X = AxisMotion.Limited, Y = AxisMotion.Limited, Z = AxisMotion.Limited, Twist = AxisMotion.Free, Swing1 = AxisMotion.Free,
            Swing2 = AxisMotion.Free, LinearLimit = new LinearLimit { Value = 0.25 },
        };
        b.Add(joint, Joint.World, body, Pose.Identity);
        MultibodySystem m = b.Build();
        m.Bodies.LinearVelocities[0] = new Vector3d(1, 0, 0.3);
        Run(m, 20);
        Assert.That((m.Bodies.Poses[0].Position - new Vector3d(0, -0.25, 0)).Length, Is.LessThanOrEqualTo(1e-6));
    }

    [Test]
    public void ConeLimit_HeavyRod_LeansOnTheCone()
    {
        // The rod stands upright along the joint's X and falls over by its weight until the cone holds it at 0.6 rad.
        var b = new MechanismBuilder();
        int rod = b.Bar(Vector3d.Zero, Vector3d.UnitY, 1);
        b.Change(rod, d =>
        {
            d.AngularVelocity = new Vector3d(0, 0, -0.5);
            d.LinearVelocity = new Vector3d(0.25, 0, 0);
            d.AngularDamping = 3;
            return d;
        });
        var joint = new D6Joint { Swing1 = AxisMotion.Limited, Swing2 = AxisMotion.Limited, SwingLimit = new ConeLimit { Y = 0.6, Z = 0.6 } };
        b.Add(joint, Joint.World, rod, Vector3d.Zero, Vector3d.UnitY);
        MultibodySystem m = b.Build();
        Run(m, 10);
        Vector3d axis = m.Bodies.Poses[0].Rotation * Vector3d.UnitX;
        Assert.That(Math.Acos(axis.Y), Is.EqualTo(0.6).Within(1e-5));
        Assert.That(MechanismMeasures.Drift(m), Is.LessThanOrEqualTo(1e-8));
    }

    [TestCase(1e-4)]
    [TestCase(3.5e-4)]
    [TestCase(5e-3)]
    public void ConeLimit_NarrowerThanAStepsWay_HoldsWithoutGain(double angle)
    {
        // In a cone's middle no direction leads out of it; 2.2 rad/s pass all of it within a step.
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int body = b.Body(Vector3d.Zero, Quaterniond.Identity, 1, new Vector3d(0.1, 0.2, 0.3));
        var joint = new D6Joint { Swing1 = AxisMotion.Limited, Swing2 = AxisMotion.Limited, SwingLimit = new ConeLimit { Y = angle, Z = angle } };
        b.Add(joint, Joint.World, body, Pose.Identity);
        MultibodySystem m = b.Build();
        m.Bodies.AngularVelocities[body] = new Vector3d(0, 1, 2);
        double energy = m.Bodies.KineticEnergy(body);
        double widest = 0;
        Run(m, 1, Dt, () => widest = Math.Max(widest, Math.Acos(Math.Min(1, (m.Bodies.Poses[body].Rotation * Vector3d.UnitX).X))));
        Assert.That(widest, Is.LessThanOrEqualTo(1.001 * angle));
        Assert.That(m.Bodies.KineticEnergy(body), Is.LessThanOrEqualTo(energy));
        Assert.That(m.Stops, Is.Zero);
    }

    [Test]
    public void LinearLimit_OfNothing_HoldsTheAnchorAndTheEnergy()
    {
        var b = new MechanismBuilder();
        int bar = b.Bar(Vector3d.Zero, Vector3d.UnitX, 1);
        var joint = new D6Joint
        {
            X = AxisMotion.Limited, Y = AxisMotion.Limited, Z = AxisMotion.Limited, Twist = AxisMotion.Free, Swing1 = AxisMotion.Free,
            Swing2 = AxisMotion.Free, LinearLimit = new LinearLimit { Value = 0 },
        };
        b.Add(joint, Joint.World, bar, Pose.Identity);
        MultibodySystem m = b.Build();
        double energy = Energy();
        Run(m, 4);
        Assert.That(m.Bodies.Poses[bar].Point(new Vector3d(-0.5, 0, 0)).Length, Is.LessThanOrEqualTo(1e-8));
        Assert.That(Energy(), Is.EqualTo(energy).Within(0.01));

        double Energy() => m.Bodies.KineticEnergy(bar) + m.Bodies.PotentialEnergy(bar, m.Gravity);
    }

    [Test]
    public void Coupling_Gear_KeepsTheRatio()
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int one = b.Body(Vector3d.Zero, Quaterniond.Identity, 1, new Vector3d(1, 1, 1));
        int two = b.Body(Vector3d.UnitX, Quaterniond.Identity, 1, new Vector3d(1, 1, 3));
        RevoluteJoint first = b.Hinge(Joint.World, one, Vector3d.Zero, Vector3d.UnitZ);
        RevoluteJoint second = b.Hinge(Joint.World, two, Vector3d.UnitX, Vector3d.UnitZ);
        b.Add(new Coupling(
            new JointCoordinate(first, CoordinateAxis.AngularX, 1), new JointCoordinate(second, CoordinateAxis.AngularX, 1), -2, 0));
        MultibodySystem m = b.Build();
        Run(m, 3, Dt, () => m.Bodies.Torques[0] = new Vector3d(0, 0, 1.3));

        // Both wheels on the first one's shaft: I = 1 + (-2)^2 3.
        Assert.That(m.Bodies.AngularVelocities[0].Z, Is.EqualTo(1.3 / 13 * 3).Within(1e-8));
        Assert.That(m.Bodies.AngularVelocities[1].Z, Is.EqualTo(-2 * 1.3 / 13 * 3).Within(1e-8));
    }

    [TestCase(0.9, true)]
    [TestCase(1.1, false)]
    public void BreakForce_AgainstTheWeight_Decides(double share, bool breaks)
    {
        var b = new MechanismBuilder();
        int body = b.Body(Vector3d.Zero, Quaterniond.Identity, 4, new Vector3d(1, 1, 1));
        b.Add(new D6Joint { BreakForce = share * 4 * 9.81 }, Joint.World, body, Pose.Identity);
        MultibodySystem m = b.Build();
        Run(m, 1);
        Assert.That(m.Joints[0].IsBroken, Is.EqualTo(breaks));
        if (!breaks)
        {
            // Actor 0 is the world, which the weight pulls down.
            Assert.That(m.Reactions[0].Force.Y, Is.EqualTo(-4 * 9.81).Within(1e-6));
        }
    }

    [Test]
    public void KinematicBody_Driven_CarriesWhatHangsOnIt()
    {
        var b = new MechanismBuilder();
        BodyDefinition d = BodyDefinition.Default;
        d.IsKinematic = true;
        int hand = b.Body(d);
        int bar = b.Bar(Vector3d.Zero, new Vector3d(0, -1, 0), 1);
        b.Hinge(hand, bar, Vector3d.Zero, Vector3d.UnitZ);
        MultibodySystem m = b.Build();
        int step = 0;
        Run(m, 2, Dt, () =>
        {
            step++;
            m.Bodies.KinematicTargets[hand] = new Pose(new Vector3d(Math.Sin(step * 0.02), 0, 0), Quaterniond.Identity);
        });
        Assert.That(m.Bodies.Poses[hand].Position.X, Is.EqualTo(Math.Sin(200 * 0.02)).Within(1e-12));
        Assert.That(MechanismMeasures.Drift(m), Is.LessThanOrEqualTo(1e-8));
    }

    private static MultibodySystem Slider(Action<D6Joint> set, double mass)
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int body = b.Body(Vector3d.Zero, Quaterniond.Identity, mass, new Vector3d(1, 1, 1));
        var joint = new D6Joint { X = AxisMotion.Free };
        set(joint);
        b.Add(joint, Joint.World, body, Pose.Identity);
        return b.Build();
    }

    private static void Motor(RevoluteJoint hinge, double speed, double torque, bool freeSpin)
    {
        hinge.MotorEnabled = true;
        hinge.MotorVelocity = speed;
        hinge.MotorForceLimit = torque;
        hinge.MotorFreeSpin = freeSpin;
    }

    private static void Limits(RevoluteJoint hinge, double lower, double upper, LimitResponse response)
    {
        hinge.LimitEnabled = true;
        hinge.Limit = new AngularLimit { Lower = lower * Math.PI / 180, Upper = upper * Math.PI / 180, Response = response };
    }
}
