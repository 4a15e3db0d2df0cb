using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>The HingeJoint's fields together, in Unity's terms: where the hinge comes to rest, how fast it turns, when it breaks.</summary>
public sealed class HingeFieldTests
{
    [TestCase(60, 20)]
    [TestCase(-60, -10)]
    [TestCase(5, 5)]
    public void SpringAndLimits_TargetBeyondTheLimits_RestsAtTheLimit(double target, double expected)
    {
        World world = Make(new HingeJoint
        {
            Axis = Vector3d.UnitZ,
            UseSpring = true,
            Spring = new JointSpring { Spring = 100, Damper = 20, TargetPosition = target },
            UseLimits = true,
            Limits = new JointLimits { Min = -10, Max = 20 },
        });

        SmallScene.Run(world, 3);

        Assert.That(Angle(world), Is.EqualTo(expected).Within(1e-3));
    }

    [Test]
    public void ExtendedLimits_BeyondHalfATurn_StopThere()
    {
        World world = Make(new HingeJoint { Axis = Vector3d.UnitZ, UseLimits = true, ExtendedLimits = true, Limits = new JointLimits { Min = -30, Max = 240 } });
        Spin(world, 4);

        SmallScene.Run(world, 3);

        Assert.That(((WorldHingeJoint)world.Joints[0]).UnwrappedAngle, Is.EqualTo(240).Within(1e-3));
        Assert.That(Angle(world), Is.EqualTo(-120).Within(1e-3));
    }

    [TestCase(2.0)]
    [TestCase(-1.0)]
    public void Limits_MinIsMax_LockTheHingeAtItsStart(double speed)
    {
        World world = Make(new HingeJoint { Axis = Vector3d.UnitZ, UseLimits = true, Limits = new JointLimits { Min = 15, Max = 15 } });
        Spin(world, speed);

        SmallScene.Run(world, 1);

        Assert.That(Angle(world), Is.EqualTo(0).Within(1e-6));
    }

    [TestCase(90, 0, 0)]
    [TestCase(90, 2, 2)]
    [TestCase(-90, 2, -2)]
    public void Motor_Force_IsItsTorqueAndNoneIsOff(double velocity, double force, double torque)
    {
        // Below its speed all the while: angle = M t^2 / 2 I by implicit Euler, 1 kg m^2, 50 steps of 0.01 s.
        World world = Make(new HingeJoint { Axis = Vector3d.UnitZ, UseMotor = true, Motor = new JointMotor { TargetVelocity = velocity, Force = force } });

        SmallScene.Run(world, 0.5);

        Assert.That(Angle(world) * Math.PI / 180, Is.EqualTo(torque * 1e-4 * 50 * 51 / 2).Within(1e-9));
    }

    [TestCase(90, 3.0, true, 3.0)]
    [TestCase(90, 3.0, false, 3.0 - 0.5)]
    [TestCase(-90, -3.0, true, -3.0)]
    [TestCase(-90, 3.0, true, 3.0 - 0.5)]
    public void MotorFreeSpin_FasterThanTheMotor_IsNotBraked(double velocity, double spin, bool freeSpin, double expected)
    {
        World world = Make(new HingeJoint { Axis = Vector3d.UnitZ, UseMotor = true, Motor = new JointMotor { TargetVelocity = velocity, Force = 1, FreeSpin = freeSpin } });
        Spin(world, spin);

        SmallScene.Run(world, 0.5);

        Assert.That(((WorldHingeJoint)world.Joints[0]).Velocity * Math.PI / 180, Is.EqualTo(expected).Within(1e-9));
    }

    [TestCase(0.5)]
    [TestCase(8.0)]
    public void UseAcceleration_Spring_MovesEveryInertiaAlike(double inertia)
    {
        World world = Make(
            new HingeJoint { Axis = Vector3d.UnitZ, UseSpring = true, UseAcceleration = true, Spring = new JointSpring { Spring = 20, Damper = 1, TargetPosition = 40 } },
            inertia);

        SmallScene.Run(world, 0.4);

        // Implicit Euler: w' = (w + h k (target - phi)) / (1 + h d + h^2 k).
        double phi = 0, w = 0;
        for (int i = 0; i < 40; i++)
        {
            w = (w + 0.01 * 20 * (40 * Math.PI / 180 - phi)) / (1 + 0.01 + 1e-4 * 20);
            phi += 0.01 * w;
        }

        Assert.That(Angle(world) * Math.PI / 180, Is.EqualTo(phi).Within(1e-9));
    }

    [TestCase(0.6, -6.0)]
    [TestCase(0.0, 0.0)]
    public void LimitsBounciness_Hit_GivesBackItsShare(double bounciness, double expected)
    {
        World world = Make(new HingeJoint { Axis = Vector3d.UnitZ, UseLimits = true, Limits = new JointLimits { Min = -10, Max = 20, Bounciness = bounciness } });
        Spin(world, 10);

        SmallScene.Run(world, 0.05);

        double speed = ((WorldHingeJoint)world.Joints[0]).Velocity * Math.PI / 180;
        Assert.That(speed, Is.EqualTo(expected).Within(1e-6));
        Assert.That(Angle(world), Is.LessThanOrEqualTo(20.001));
    }

    [TestCase(11.7, true)]
    [TestCase(11.9, false)]
    public void BreakTorque_WeightOnAnArm_BreaksOnceWithItsEvent(double breakTorque, bool breaks)
    {
        // 3 kg at 0.4 m along X: 11.772 N m about Z, across the hinge's X.
        var scene = new SceneDocument
        {
            GameObjects =
            [
                new GameObject
                {
                    Id = "own",
                    Name = "own",
                    Components = [new Rigidbody { Mass = 3, AngularDamping = 0 }, new HingeJoint { Anchor = new Vector3d(-0.4, 0, 0), BreakTorque = breakTorque }],
                },
            ],
        };
        World world = World.Create(SmallScene.Validate(scene));
        var broken = new List<WorldJoint>();
        world.JointBroken += (_, e) => broken.Add(e.Joint);

        SmallScene.Run(world, 0.3);

        Assert.That(broken, Has.Count.EqualTo(breaks ? 1 : 0));
        Assert.That(world.Joints[0].IsBroken, Is.EqualTo(breaks));
    }

    private static World Make(HingeJoint hinge, double inertia = 1) => SmallScene.Create(
        hinge, new Rigidbody { AngularDamping = 0, MaxAngularVelocity = 100, InertiaTensor = new Vector3d(inertia, inertia, inertia) });

    private static double Angle(World world) => ((WorldHingeJoint)world.Joints[0]).Angle;

    private static void Spin(World world, double speed) => world.Bodies[0].AngularVelocity = SmallScene.OwnPose.Rotation * new Vector3d(0, 0, speed);
}
