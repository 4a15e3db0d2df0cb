using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>What a world does while it runs: readings, events, run-time changes, kinematic bodies, couplings, no rubbish.</summary>
public sealed class WorldStepTests
{
    private static readonly Physics NoGravity = new() { Gravity = Vector3d.Zero };

    [Test]
    public void HingeJoint_Angle_WrapsAndUnwraps()
    {
        World world = SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ, UseMotor = true, Motor = new JointMotor { TargetVelocity = 360, Force = 1e6 } });
        var hinge = (WorldHingeJoint)world.Joints[0];

        SmallScene.Run(world, 1.75);

        Assert.That(hinge.UnwrappedAngle, Is.EqualTo(630).Within(1e-3));
        Assert.That(hinge.Angle, Is.EqualTo(-90).Within(1e-3));
        Assert.That(hinge.Coordinate(Coordinate.Angle), Is.EqualTo(hinge.UnwrappedAngle));
    }

    /// <summary>A body that its stops throw to and fro within a step: where its speed at the end of the step would lead to is not where it is.</summary>
    [TestCase(false)]
    [TestCase(true)]
    public void Coordinate_BetweenStopsThatThrowItBack_IsCountedAsItMoved(bool isTwist)
    {
        const double bounciness = 1, low = -10, high = 80, most = 100;
        Kinefab.Document.Joint joint = isTwist
            ? new ConfigurableJoint
            {
                Axis = Vector3d.UnitZ,
                SecondaryAxis = Vector3d.UnitX,
                XMotion = ConfigurableJointMotion.Locked,
                YMotion = ConfigurableJointMotion.Locked,
                ZMotion = ConfigurableJointMotion.Locked,
                AngularYMotion = ConfigurableJointMotion.Locked,
                AngularZMotion = ConfigurableJointMotion.Locked,
                AngularXMotion = ConfigurableJointMotion.Limited,
                LowAngularXLimit = new SoftJointLimit { Limit = -high, Bounciness = bounciness },
                HighAngularXLimit = new SoftJointLimit { Limit = -low, Bounciness = bounciness },
            }
            : new HingeJoint
            {
                Axis = Vector3d.UnitZ,
                UseLimits = true,
                Limits = new JointLimits { Min = low, Max = high, Bounciness = bounciness },
            };
        var body = new Rigidbody { Mass = 1, InertiaTensor = new Vector3d(0.01, 0.01, 0.01), AngularDamping = 0, MaxAngularVelocity = 1e5, UseGravity = false };
        GameObject own = new() { Id = "own", Name = "own", Components = [body, joint] };
        World world = World.Create(SmallScene.Validate(new SceneDocument { GameObjects = [own] }), SolverKind.Exact);
        world.Bodies[0].AngularVelocity = 500 * Vector3d.UnitZ;

        for (int i = 0; i < 60; i++)
        {
            world.Step(1.0 / 60);
            double angle = world.Joints[0].Coordinate(isTwist ? Coordinate.AngularX : Coordinate.Angle);
            Assert.That(angle, Is.InRange(low - 1e-3, high + 1e-3), $"step {i}");
            Assert.That(world.Bodies[0].AngularVelocity.Length, Is.GreaterThan(most));
        }
    }

    [Test]
    public void Coordinate_OfABodyThatIsSetToMoreThanATurnAStep_HasItFromTheFirstStep([Values] SolverKind solver, [Values] bool isHinge, [Values(500, -900)] double way)
    {
        ConfigurableJointMotion locked = ConfigurableJointMotion.Locked;
        Joint joint = isHinge
            ? new HingeJoint { Axis = Vector3d.UnitX }
            : new ConfigurableJoint { XMotion = locked, YMotion = locked, ZMotion = locked, AngularYMotion = locked, AngularZMotion = locked };
        World world = SmallScene.Create(joint, new Rigidbody { AngularDamping = 0, MaxAngularVelocity = 1e4 }, solver: solver);
        Coordinate coordinate = world.Joints[0].FreeCoordinates[0];
        double before = 0;
        for (int i = 0; i < 6; i++)
        {
            // Turned round after three steps.
            if (i % 3 == 0)
                world.Bodies[0].AngularVelocity = SmallScene.OwnPose.Rotation * Vector3d.UnitX * ((i == 0 ? way : -way) * Math.PI / 180 / SmallScene.Dt);
            WorldSnapshot snapshot = world.Snapshot();
            world.Step(SmallScene.Dt);
            double reached = world.Joints[0].Coordinate(coordinate);
            Assert.That(Math.Abs(reached - before), Is.EqualTo(Math.Abs(way)).Within(1e-3));
            world.Restore(snapshot);
            world.Step(SmallScene.Dt);
            Assert.That(world.Joints[0].Coordinate(coordinate), Is.EqualTo(reached));
            before = reached;
        }

        Assert.That(before, Is.Zero.Within(1e-3));
    }

    [Test]
    public void CurrentForce_HangingBody_IsItsWeight()
    {
        SceneDocument document = Hanging(new FixedJoint());
        World world = World.Create(SmallScene.Validate(document));

        SmallScene.Run(world, 0.1);

        Vector3d force = world.Joints[0].CurrentForce;
        Assert.That((force - new Vector3d(0, 3 * 9.81, 0)).Length, Is.LessThan(1e-9), force.ToString());
    }

    [Test]
    public void CurrentTorque_CantileveredBody_IsItsWeightTimesItsArm()
    {
        // The weight at 0.4 m along X from the anchor turns it by (0.4, 0, 0) x (0, -29.43, 0); the wall gives the opposite.
        SceneDocument document = Hanging(new ConfigurableJoint
        {
            Anchor = new Vector3d(-0.4, 0, 0),
            XMotion = ConfigurableJointMotion.Locked,
            YMotion = ConfigurableJointMotion.Locked,
            ZMotion = ConfigurableJointMotion.Locked,
            AngularXMotion = ConfigurableJointMotion.Locked,
            AngularYMotion = ConfigurableJointMotion.Locked,
            AngularZMotion = ConfigurableJointMotion.Locked,
        });
        World world = World.Create(SmallScene.Validate(document));

        SmallScene.Run(world, 0.1);

        Vector3d torque = world.Joints[0].CurrentTorque;
        Assert.That((torque - new Vector3d(0, 0, 0.4 * 3 * 9.81)).Length, Is.LessThan(1e-6), torque.ToString());
    }

    [TestCase(29.4, true)]
    [TestCase(29.5, false)]
    public void BreakForce_WeightOf29_43_BreaksOnceAndFalls(double breakForce, bool breaks)
    {
        World world = World.Create(SmallScene.Validate(Hanging(new FixedJoint { BreakForce = breakForce })));
        var broken = new List<WorldJoint>();
        world.JointBroken += (_, e) => broken.Add(e.Joint);

        SmallScene.Run(world, 0.5);

        Assert.That(broken, Has.Count.EqualTo(breaks ? 1 : 0));
        Assert.That(world.Joints[0].IsBroken, Is.EqualTo(breaks));
        Assert.That(world.Bodies[0].Pose.Position.Y, breaks ? Is.LessThan(-0.5) : Is.EqualTo(0).Within(1e-9));
    }

    [Test]
    public void JointBroken_AHandlerThatThrows_KeepsNothingFromTheOthers()
    {
        GameObject[] hung = [.. Enumerable.Range(0, 2).Select(i => new GameObject { Id = $"{i}", Name = $"{i}", Components = [new Rigidbody(), new FixedJoint { BreakForce = 1 }] })];
        World world = World.Create(SmallScene.Validate(new SceneDocument { GameObjects = hung }));
        var broken = new List<WorldJoint>();
        world.JointBroken += (_, _) => throw new InvalidTimeZoneException();
        world.JointBroken += (_, e) => broken.Add(e.Joint);

        Assert.That(() => world.Step(0.02), Throws.InstanceOf<InvalidTimeZoneException>());
        Assert.That(broken, Is.EqualTo(world.Joints));
        Assert.That(() => world.Step(0.02), Throws.Nothing);
        Assert.That((broken.Count, world.Time), Is.EqualTo((2, 0.04)));
    }

    [Test]
    public void Settings_ChangedWhileRunning_ActFromTheNextStep()
    {
        World world = SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ });
        var hinge = (WorldHingeJoint)world.Joints[0];
        SmallScene.Run(world, 0.2);

        hinge.Settings = new HingeJoint { Axis = Vector3d.UnitZ, UseMotor = true, Motor = new JointMotor { TargetVelocity = -20, Force = 1e6 } };
        SmallScene.Run(world, 1);

        Assert.That(hinge.Angle, Is.EqualTo(-20).Within(1e-3));
    }

    [Test]
    public void Settings_SwapBodiesChanged_Throws()
    {
        World world = SmallScene.Create(new ConfigurableJoint());

        Assert.That(() => ((WorldConfigurableJoint)world.Joints[0]).Settings = new ConfigurableJoint { SwapBodies = true }, Throws.ArgumentException);
    }

    [Test]
    public void Step_BodyAtTheOrigin_IsHeldFromTheFirstStep([Values] SolverKind solver)
    {
        World world = World.Create(
            SmallScene.Validate(new SceneDocument
            {
                GameObjects =
                [
                    new() { Id = "own", Name = "own", Components = [new Rigidbody(), new HingeJoint { UseMotor = true, Motor = new JointMotor { TargetVelocity = 90, Force = 1e6 } }] },
                ],
            }),
            solver);
        world.Step(0.02);
        Assert.That(world.Bodies[0].AngularVelocity.X, Is.EqualTo(Math.PI / 2).Within(1e-6));
        Assert.That(world.Bodies[0].LinearVelocity.Y, Is.EqualTo(0).Within(1e-6));
        Assert.That(world.Joints[0].CurrentForce.Y, Is.EqualTo(9.81).Within(1e-6));
    }

    [Test]
    public void CurrentForce_BrokenJoint_IsWhatBrokeItThenNone([Values] SolverKind solver)
    {
        World world = World.Create(
            SmallScene.Validate(new SceneDocument { GameObjects = [new() { Id = "own", Name = "own", Components = [new Rigidbody(), new FixedJoint { BreakForce = 5 }] }] }),
            solver);
        double breaking = 0;
        world.JointBroken += (_, e) => breaking = e.Joint.CurrentForce.Y;
        world.Step(0.02);
        Assert.That(breaking, Is.EqualTo(9.81).Within(1e-6));
        world.Step(0.02);
        Assert.That(world.Joints[0].CurrentForce, Is.EqualTo(Vector3d.Zero));
    }

    [Test]
    public void Settings_NumberNoFileMayState_ThrowsAndChangesNothing()
    {
        World world = SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ });
        var hinge = (WorldHingeJoint)world.Joints[0];
        HingeJoint before = hinge.Settings;
        Assert.That(() => hinge.Settings = new HingeJoint { UseMotor = true, Motor = new JointMotor { TargetVelocity = double.NaN } }, Throws.ArgumentException);
        Assert.That(() => hinge.Settings = new HingeJoint { UseSpring = true, Spring = new JointSpring { Spring = -1 } }, Throws.ArgumentException);
        Assert.That(hinge.Settings, Is.SameAs(before));
        world = SmallScene.Create(new ConfigurableJoint());
        Assert.That(
            () => ((WorldConfigurableJoint)world.Joints[0]).Settings = new ConfigurableJoint { XDrive = new JointDrive { PositionSpring = double.NaN } },
            Throws.ArgumentException);
    }

    // PhysX would lock such a hinge at 0, and hold a radius below 0 for none.
    [Test]
    public void Settings_LimitsThatNoFileMayState_Throw()
    {
        var hinge = (WorldHingeJoint)SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ }).Joints[0];
        var joint = (WorldConfigurableJoint)SmallScene.Create(new ConfigurableJoint()).Joints[0];
        Assert.That(() => hinge.Settings = new HingeJoint { UseLimits = true, Limits = new JointLimits { Min = 50, Max = -50 } }, Throws.ArgumentException.With.Message.Contains("50"));
        foreach (ConfigurableJoint wrong in new ConfigurableJoint[]
        {
            new() { LinearLimit = new SoftJointLimit { Limit = -0.1 } },
            new() { AngularYLimit = new SoftJointLimit { Limit = -10 } },
            new() { LowAngularXLimit = new SoftJointLimit { Limit = 10 }, HighAngularXLimit = new SoftJointLimit { Limit = -10 } },
        })
        {
            Assert.That(() => joint.Settings = wrong, Throws.ArgumentException);
        }
    }

    [TestCase(double.NaN)]
    [TestCase(double.PositiveInfinity)]
    public void Drive_NoNumber_Throws(double value)
    {
        foreach (WorldJoint joint in new[] { SmallScene.Create(new HingeJoint()).Joints[0], SmallScene.Create(new ConfigurableJoint()).Joints[0] })
        {
            Coordinate coordinate = joint is WorldHingeJoint ? Coordinate.Angle : Coordinate.AngularX;
            Assert.That(() => joint.DriveTo(coordinate, value), Throws.InstanceOf<ArgumentOutOfRangeException>());
            Assert.That(() => joint.DriveAt(coordinate, value), Throws.InstanceOf<ArgumentOutOfRangeException>());
        }
    }

    [Test]
    public void HingeJoint_MotorAndSpring_MotorWins()
    {
        World world = SmallScene.Create(new HingeJoint
        {
            Axis = Vector3d.UnitZ,
            UseMotor = true,
            Motor = new JointMotor { TargetVelocity = 30, Force = 1e6 },
            UseSpring = true,
            Spring = new JointSpring { Spring = 1e4, Damper = 10, TargetPosition = -50 },
        });

        SmallScene.Run(world, 1);

        Assert.That(((WorldHingeJoint)world.Joints[0]).Angle, Is.EqualTo(30).Within(1e-3));
    }

    [Test]
    public void KinematicBody_Target_IsReachedAndCarriesTheJoint()
    {
        World world = SmallScene.Create(new FixedJoint { ConnectedBody = 1 }, connected: true);
        Pose start = world.Bodies[1].Pose;
        Pose relative = start.Inverse() * world.Bodies[0].Pose;

        for (int i = 1; i <= 100; i++)
        {
            world.Bodies[1].KinematicTarget = new Pose(start.Position + new Vector3d(0.003 * i, 0, 0), Quaterniond.AxisAngle(Vector3d.UnitY, 0.01 * i) * start.Rotation);
            world.Step(SmallScene.Dt);
        }

        Assert.That((world.Bodies[1].Pose.Position - start.Position - new Vector3d(0.3, 0, 0)).Length, Is.LessThan(1e-9));
        Pose carried = world.Bodies[1].Pose * relative;
        Assert.That((world.Bodies[0].Pose.Position - carried.Position).Length, Is.LessThan(1e-3));
    }

    [TestCase(-2.0, 0.0)]
    [TestCase(0.5, 15.0)]
    public void Coupling_Gear_HoldsTheAnglesRatio(double ratio, double offset)
    {
        World world = Geared(CouplingKind.Gear, ratio, offset);

        SmallScene.Run(world, 2);

        double a = world.Joints[0].Coordinate(Coordinate.Angle);
        double b = world.Joints[1].Coordinate(Coordinate.Angle);
        Assert.That(a, Is.EqualTo(200).Within(0.5), "the motor turns it");
        Assert.That(b, Is.EqualTo(ratio * a + offset).Within(1e-2));
    }

    [Test]
    public void Coupling_Screw_TiesSlideAndAngleOfOneJoint()
    {
        // A pitch of 5 mm a turn: x = 0.005 / 360 * angle. The free screw starts with a spin.
        var joint = new ConfigurableJoint
        {
            Axis = Vector3d.UnitZ,
            YMotion = ConfigurableJointMotion.Locked,
            ZMotion = ConfigurableJointMotion.Locked,
            AngularYMotion = ConfigurableJointMotion.Locked,
            AngularZMotion = ConfigurableJointMotion.Locked,
        };
        SceneDocument document = SmallScene.Document(joint, new Rigidbody { AngularDamping = 0, MaxAngularVelocity = 100 }, connected: false);
        var scene = new SceneDocument
        {
            Physics = NoGravity,
            GameObjects = document.GameObjects,
            Couplings = [new Coupling { Kind = CouplingKind.Screw, A = new JointCoordinate { Component = 1, Coordinate = Coordinate.AngularX }, B = new JointCoordinate { Component = 1, Coordinate = Coordinate.X }, Ratio = 0.005 / 360 }],
        };
        World world = World.Create(SmallScene.Validate(scene));
        world.Bodies[0].AngularVelocity = SmallScene.OwnPose.Rotation * new Vector3d(0, 0, 20);

        SmallScene.Run(world, 2);

        double angle = world.Joints[0].Coordinate(Coordinate.AngularX);
        Assert.That(angle, Is.GreaterThan(2000));
        Assert.That(world.Joints[0].Coordinate(Coordinate.X), Is.EqualTo(0.005 / 360 * angle).Within(1e-6));
        Assert.That(SmallScene.Way(world).Z, Is.EqualTo(0.005 / 360 * angle).Within(1e-6), "along +axis for a positive turn");
    }

    [TestCase(CouplingKind.Rack)]
    [TestCase(CouplingKind.Linear)]
    public void Coupling_AngleToSlide_HoldsMetresADegree(CouplingKind kind)
    {
        // A pinion of 20 mm radius, driven, and a rack on X.
        const double ratio = 0.02 * Math.PI / 180;
        var rack = new ConfigurableJoint
        {
            YMotion = ConfigurableJointMotion.Locked,
            ZMotion = ConfigurableJointMotion.Locked,
            AngularXMotion = ConfigurableJointMotion.Locked,
            AngularYMotion = ConfigurableJointMotion.Locked,
            AngularZMotion = ConfigurableJointMotion.Locked,
        };
        World world = World.Create(SmallScene.Validate(new SceneDocument
        {
            Physics = NoGravity,
            GameObjects =
            [
                new GameObject { Id = "pinion", Name = "pinion", Components = [new Rigidbody(), new HingeJoint { Axis = Vector3d.UnitZ, UseMotor = true, Motor = new JointMotor { TargetVelocity = -100, Force = 1e4 } }] },
                new GameObject { Id = "rack", Name = "rack", Components = [new Rigidbody(), rack] },
            ],
            Couplings = [new Coupling { Kind = kind, A = new JointCoordinate { GameObject = 0, Component = 1, Coordinate = Coordinate.Angle }, B = new JointCoordinate { GameObject = 1, Component = 1, Coordinate = Coordinate.X }, Ratio = ratio }],
        }));

        SmallScene.Run(world, 2);

        Assert.That(world.Joints[0].Coordinate(Coordinate.Angle), Is.EqualTo(-200).Within(1), "the motor turns it");
        Assert.That(world.Bodies[1].Pose.Position.X, Is.EqualTo(ratio * world.Joints[0].Coordinate(Coordinate.Angle)).Within(1e-5));
    }

    /// <summary>A differential: the third wheel turns by the mean of two that motors drive, less an offset.</summary>
    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void Coupling_OfTwoTerms_FollowsTheirSum(SolverKind solver)
    {
        World world = World.Create(Differential(), solver);
        SmallScene.Run(world, 2);

        double first = world.Joints[0].Coordinate(Coordinate.Angle);
        double second = world.Joints[1].Coordinate(Coordinate.Angle);
        Assert.That(first, Is.EqualTo(200).Within(2), "the motor turns it, from where the wheels close the offset");
        Assert.That(second, Is.EqualTo(-60).Within(2), "the motor turns it, from where the wheels close the offset");
        Assert.That(world.Joints[2].Coordinate(Coordinate.Angle), Is.EqualTo((first + second) / 2 - 5).Within(1e-4));
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void Restore_InACouplingOfTwoTerms_GoesOnWithTheSameBits(SolverKind solver)
    {
        World world = World.Create(Differential(), solver);
        SmallScene.Run(world, 3);
        WorldSnapshot saved = world.Snapshot();
        SmallScene.Run(world, 3);
        ulong reached = world.StateHash();
        world.Restore(saved);
        SmallScene.Run(world, 3);
        Assert.That(world.StateHash(), Is.EqualTo(reached));
    }

    [TestCase(false)]
    [TestCase(true)]
    public void Step_AfterWarmUp_AllocatesNothing(bool isSum)
    {
        World world = isSum ? World.Create(Differential()) : Geared(CouplingKind.Gear, -2, 0);
        SmallScene.Run(world, 0.5);

        Assert.That(AllocatedBytes.LeastOf(() => SmallScene.Run(world, 1)), Is.Zero);
    }

    [Test]
    public void Step_SameScene_GivesTheSameBits()
    {
        World a = Geared(CouplingKind.Gear, -2, 0);
        World b = Geared(CouplingKind.Gear, -2, 0);

        SmallScene.Run(a, 3);
        SmallScene.Run(b, 3);

        for (int i = 0; i < a.Bodies.Count; i++)
        {
            Assert.That(a.Bodies[i].Pose.Position == b.Bodies[i].Pose.Position && a.Bodies[i].Pose.Rotation == b.Bodies[i].Pose.Rotation);
        }
    }

    [TestCase(0)]
    [TestCase(-0.1)]
    [TestCase(double.NaN)]
    [TestCase(double.PositiveInfinity)]
    public void Step_NotAPositiveTime_Throws(double dt) =>
        Assert.That(() => SmallScene.Create(new FixedJoint()).Step(dt), Throws.InstanceOf<ArgumentOutOfRangeException>());

    private static SceneDocument Hanging(Joint joint) => new()
    {
        GameObjects = [new GameObject { Id = "own", Name = "own", Components = [new Rigidbody { Mass = 3, AngularDamping = 0 }, joint] }],
    };

    /// <summary>Two wheels on the world, the first driven at 100 degrees/s, coupled.</summary>
    private static World Geared(CouplingKind kind, double ratio, double offset) => World.Create(SmallScene.Validate(new SceneDocument
    {
        Physics = NoGravity,
        GameObjects = [Wheel("a", 0, 100), Wheel("b", 1, null)],
        Couplings = [new Coupling { Kind = kind, A = Angle(0), B = Angle(1), Ratio = ratio, Offset = offset }],
    }));

    private static ValidScene Differential() => SmallScene.Validate(new SceneDocument
    {
        Physics = NoGravity,
        GameObjects = [Wheel("a", 0, 100), Wheel("b", 1, -30), Wheel("c", 2, null)],
        Couplings =
        [
            new Coupling
            {
                B = Angle(2),
                Terms = [new CouplingTerm { Coordinate = Angle(0), Ratio = 0.5 }, new CouplingTerm { Coordinate = Angle(1), Ratio = 0.5 }],
                Offset = -5,
            },
        ],
    });

    private static JointCoordinate Angle(int gameObject) => new() { GameObject = gameObject, Component = 1, Coordinate = Coordinate.Angle };

    // driven: by a motor at so many degrees/s.
    private static GameObject Wheel(string id, double x, double? driven) => new()
    {
        Id = id,
        Name = id,
        Transform = new Transform { LocalPosition = new Vector3d(x, 0, 0), LocalRotation = Quaterniond.AxisAngle(Vector3d.UnitY, 0.3 * x) },
        Components =
        [
            new Rigidbody { MaxAngularVelocity = 100, InertiaTensor = new Vector3d(0.2, 0.2, 0.3) },
            new HingeJoint { Axis = Vector3d.UnitZ, UseMotor = driven is not null, Motor = new JointMotor { TargetVelocity = driven ?? 0, Force = 1e4 } },
        ],
    };
}
