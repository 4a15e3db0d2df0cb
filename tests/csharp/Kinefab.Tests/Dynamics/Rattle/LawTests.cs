using System;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;
using static Kinefab.Tests.Dynamics.Rattle.LawScenes;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Motors, couplings, breaking and kinematic bodies, against closed forms.</summary>
internal sealed class LawTests
{
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
        Motor(b.Hinge(JointModel.World, wheel, new Vector3d(x, 0, 0), Vector3d.UnitZ), 6, 4, false);
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
    public void MotorThenSpring_SwitchedWhileRunning_ActsAsTheSpringAlone()
    {
        MultibodySystem m = Wheel(h => Motor(h, 6, 1000, false));
        var hinge = (RevoluteJoint)m.Joints[0];
        Run(m, 0.1);
        var solver = new RattleSolver(m);
        solver.Step(Dt);
        hinge.MotorEnabled = false;
        hinge.Spring = new DriveModel { Damping = 3, ForceLimit = double.PositiveInfinity };
        for (int i = 0; i < 100; i++)
        {
            solver.Step(Dt);
        }

        Assert.That(Speed(m), Is.EqualTo(6 * Math.Exp(-3.0 / 2)).Within(1e-4));
    }

    [Test]
    public void Coupling_Gear_KeepsTheRatio()
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int one = b.Body(Vector3d.Zero, Quaterniond.Identity, 1, new Vector3d(1, 1, 1));
        int two = b.Body(Vector3d.UnitX, Quaterniond.Identity, 1, new Vector3d(1, 1, 3));
        RevoluteJoint first = b.Hinge(JointModel.World, one, Vector3d.Zero, Vector3d.UnitZ);
        RevoluteJoint second = b.Hinge(JointModel.World, two, Vector3d.UnitX, Vector3d.UnitZ);
        b.Couple(second, (first, -2));
        MultibodySystem m = b.Build();
        Run(m, 3, Dt, () => m.Bodies.Torques[0] = new Vector3d(0, 0, 1.3));

        // Both wheels on the first one's shaft: I = 1 + (-2)^2 3.
        Assert.That(m.Bodies.AngularVelocities[0].Z, Is.EqualTo(1.3 / 13 * 3).Within(1e-8));
        Assert.That(m.Bodies.AngularVelocities[1].Z, Is.EqualTo(-2 * 1.3 / 13 * 3).Within(1e-8));
    }

    [Test]
    public void Coupling_OfTwoTerms_CarriesBothTorques()
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        var hinges = new RevoluteJoint[3];
        for (int i = 0; i < 3; i++)
        {
            int body = b.Body(Vector3d.UnitX * i, Quaterniond.Identity, 1, new Vector3d(1, 1, 1 + i));
            hinges[i] = b.Hinge(JointModel.World, body, Vector3d.UnitX * i, Vector3d.UnitZ);
        }

        b.Couple(hinges[2], (hinges[0], -2), (hinges[1], 0.5));
        MultibodySystem m = b.Build();
        Run(m, 3, Dt, () => (m.Bodies.Torques[0], m.Bodies.Torques[1]) = (new Vector3d(0, 0, 1.3), new Vector3d(0, 0, -0.4)));

        // w2 = -2 w0 + w1 / 2; the third wheel, I = 3, seen from the two others: M = [1 + 4 * 3, -3; -3, 2 + 3 / 4].
        double determinant = 13 * 2.75 - 9;
        double w0 = (2.75 * 1.3 + 3 * -0.4) / determinant * 3;
        double w1 = (3 * 1.3 + 13 * -0.4) / determinant * 3;
        Assert.That(m.Bodies.AngularVelocities[0].Z, Is.EqualTo(w0).Within(1e-8));
        Assert.That(m.Bodies.AngularVelocities[1].Z, Is.EqualTo(w1).Within(1e-8));
        Assert.That(m.Bodies.AngularVelocities[2].Z, Is.EqualTo(-2 * w0 + w1 / 2).Within(1e-8));
    }

    [TestCase(0.9, true)]
    [TestCase(1.1, false)]
    public void BreakForce_AgainstTheWeight_Decides(double share, bool breaks)
    {
        var b = new MechanismBuilder();
        int body = b.Body(Vector3d.Zero, Quaterniond.Identity, 4, new Vector3d(1, 1, 1));
        b.Add(new D6Joint { BreakForce = share * 4 * 9.81 }, JointModel.World, body, Pose.Identity);
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
}
