using System;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;
using static Kinefab.Tests.Dynamics.Rattle.LawScenes;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Limits alone, against closed forms: where they stop, hold, give and throw back.</summary>
internal sealed class LimitLawTests
{
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
        var solver = new RattleSolver(m);
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
    public void HardLimit_OnTheOtherSide_StopsThere()
    {
        MultibodySystem m = Wheel(h => Limits(h, -10, 80, default), -1);
        Run(m, 1);
        Assert.That(Angle(m), Is.EqualTo(-10 * Math.PI / 180).Within(1e-8));
    }

    // Thrown from rest so far that its pose at the step's end tells another turn: in lanes it is stepped without rows for its limits.
    [TestCase(3.5)]
    [TestCase(-4.5)]
    public void HardLimits_ThrownPastWithinAStep_AreSeen(double turn)
    {
        MultibodySystem m = Wheel(h => Limits(h, -170, 170, default));
        var solver = new RattleSolver(m);
        solver.Step(Dt);
        m.Bodies.Torques[0] = new Vector3d(0, 0, 2 * turn * 2 / (Dt * Dt));
        solver.Step(Dt);
        Assert.That(m.Joints[0].LastTwist, Is.EqualTo(Math.Sign(turn) * 170 * Math.PI / 180).Within(1e-8));
    }

    [Test]
    public void HardLimit_StruckBesideAMotor_TakesUnitysLargestForceForNoLimit()
    {
        MultibodySystem endless = Struck(double.PositiveInfinity), largest = Struck(float.MaxValue);
        Assert.That(endless.Bodies.AngularVelocities[1].Z, Is.LessThan(2));
        Assert.That(largest.Bodies.AngularVelocities[1].Z, Is.EqualTo(endless.Bodies.AngularVelocities[1].Z).Within(1e-9));

        // A motor turns a bar, on which another comes to a limit at 20 degrees and is thrown back.
        static MultibodySystem Struck(double force)
        {
            var b = new MechanismBuilder { Gravity = Vector3d.Zero };
            int driven = b.Bar(Vector3d.Zero, new Vector3d(1, 0, 0), 1);
            int loose = b.Bar(new Vector3d(1, 0, 0), new Vector3d(2, 0, 0), 1);
            Motor(b.Hinge(JointModel.World, driven, Vector3d.Zero, Vector3d.UnitZ), 2, force, false);
            Limits(b.Hinge(driven, loose, new Vector3d(1, 0, 0), Vector3d.UnitZ), -20, 20, new LimitResponse { Restitution = 0.5 });
            b.Change(driven, d => { d.AngularVelocity = new Vector3d(0, 0, 2); d.LinearVelocity = new Vector3d(0, 1, 0); return d; });
            b.Change(loose, d => { d.AngularVelocity = new Vector3d(0, 0, 6); d.LinearVelocity = new Vector3d(0, 5, 0); return d; });
            MultibodySystem m = b.Build();
            Run(m, 0.12);
            return m;
        }
    }

    [Test]
    public void HardLimits_NeverReached_TakeNoEnergyFromAFastPendulum()
    {
        // Its energy swings about its value with the bars: whoever mends gains and lets losses pass lets it run down, here by 2 J in 5 s.
        var builder = new MechanismBuilder();
        var along = new Vector3d(Math.Sin(1.5), -Math.Cos(1.5), 0);
        var inertia = new Vector3d(0.1, 0.02, 0.1);
        int upper = builder.Body(along * 0.5, Quaterniond.Identity, 1.5, inertia);
        int lower = builder.Body(along * 1.5, Quaterniond.Identity, 2.5, inertia);
        builder.Hinge(JointModel.World, upper, default, Vector3d.UnitZ);
        builder.Hinge(upper, lower, along, Vector3d.UnitZ);
        MultibodySystem m = builder.Build();
        foreach (JointModel joint in m.Joints)
            Limits((RevoluteJoint)joint, -1e5, 1e5, default);
        double start = MechanismMeasures.Energy(m);
        var solver = new RattleSolver(m);
        for (int i = 0; i < 250; i++)
            solver.Step(0.02);
        Assert.That(MechanismMeasures.Energy(m), Is.EqualTo(start).Within(0.5));
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
        b.Add(joint, JointModel.World, body, Pose.Identity);
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
        b.Add(joint, JointModel.World, rod, Vector3d.Zero, Vector3d.UnitY);
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
        b.Add(joint, JointModel.World, body, Pose.Identity);
        MultibodySystem m = b.Build();
        m.Bodies.AngularVelocities[body] = new Vector3d(0, 1, 2);
        double energy = m.Bodies.KineticEnergy(body);
        double widest = 0;
        Run(m, 1, Dt, () => widest = Math.Max(widest, Math.Acos(Math.Min(1, (m.Bodies.Poses[body].Rotation * Vector3d.UnitX).X))));
        Assert.That(widest, Is.LessThanOrEqualTo(1.001 * angle));
        Assert.That(m.Bodies.KineticEnergy(body), Is.LessThanOrEqualTo(energy));
        Assert.That(m.Stops, Is.Zero);
    }

    /// <summary>
    /// A ball thrown back in a round hole: between two blows its path is a chord, so that the limit is left and reached again within a step, and its
    /// angular momentum about the hole's middle stays, as its energy does.
    /// </summary>
    [TestCase(0.01, 0.3)]
    [TestCase(0.006, 0.7)]
    [TestCase(0.004, 1.2)]
    public void LinearLimit_LeftAndReachedAgainWithinAStep_StrikesEachTime(double radius, double angle)
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int ball = b.Body(Vector3d.Zero, Quaterniond.Identity, 0.7, new Vector3d(1, 1, 1));
        var response = new LimitResponse { Restitution = 1, BounceThreshold = 1e-3 };
        b.Add(new D6Joint { X = AxisMotion.Limited, Y = AxisMotion.Limited, LinearLimit = new LinearLimit { Value = radius, Response = response } }, JointModel.World, ball, Pose.Identity);
        MultibodySystem m = b.Build();
        m.Bodies.Poses[ball] = new Pose(new Vector3d(radius, 0, 0), Quaterniond.Identity);
        m.Bodies.LinearVelocities[ball] = new Vector3d(-Math.Cos(angle), Math.Sin(angle), 0);
        double momentum = radius * Math.Sin(angle);
        Run(m, 1, Dt, () =>
        {
            Vector3d v = m.Bodies.LinearVelocities[ball];
            Assert.That(v.Length, Is.EqualTo(1).Within(1e-6));
            Assert.That(Vector3d.Cross(m.Bodies.Poses[ball].Position, v).Z, Is.EqualTo(momentum).Within(1e-6 * radius));
        });
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
        b.Add(joint, JointModel.World, bar, Pose.Identity);
        MultibodySystem m = b.Build();
        double energy = Energy();
        Run(m, 4);
        Assert.That(m.Bodies.Poses[bar].Point(new Vector3d(-0.5, 0, 0)).Length, Is.LessThanOrEqualTo(1e-8));
        Assert.That(Energy(), Is.EqualTo(energy).Within(0.01));

        double Energy() => m.Bodies.KineticEnergy(bar) + m.Bodies.PotentialEnergy(bar, m.Gravity);
    }
}
