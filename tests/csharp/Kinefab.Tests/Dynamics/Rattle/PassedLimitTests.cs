using System;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Limits at half a turn and beyond, of which one is passed at a bad moment, and such that no pose satisfies.</summary>
public sealed class PassedLimitTests
{
    private static readonly Rigidbody Body = new() { Mass = 1, InertiaTensor = new Vector3d(0.1, 0.1, 0.1), AngularDamping = 0, MaxAngularVelocity = 100 };

    [TestCase(-270, 30, false, -200, -180)]
    [TestCase(-30, 270, false, 200, 180)]
    [TestCase(-270, 30, true, -200, -270)]
    [TestCase(-350, 30, true, -700, -350)]
    [TestCase(-180, 180, false, 300, 180)]
    [TestCase(-170, 175, false, 300, 175)]
    public void Motor_AgainstAStop_StopsWhereUnityEndsTheRange(double min, double max, bool extended, double speed, double expected)
    {
        var hinge = new HingeJoint
        {
            Axis = Vector3d.UnitZ,
            UseLimits = true,
            ExtendedLimits = extended,
            Limits = new JointLimits { Min = min, Max = max },
            UseMotor = true,
            Motor = new JointMotor { TargetVelocity = speed, Force = 100 },
        };
        World world = SmallScene.Create(hinge, Body, solver: SolverKind.Exact);

        SmallScene.Run(world, 3);

        Assert.That(world.Joints[0].Coordinate(Coordinate.Angle), Is.EqualTo(expected).Within(1e-5));
        Assert.That((world.Stops, world.Joints[0].IsAtLimit), Is.EqualTo((0, true)));
    }

    [TestCase(true, 1)]
    [TestCase(true, 0.9)]
    [TestCase(false, 1)]
    public void Swing_ThrownBetweenItsStops_IsCountedBetweenThem(bool isY, double bounciness)
    {
        const double limit = 43;
        var joint = new ConfigurableJoint
        {
            XMotion = ConfigurableJointMotion.Locked,
            YMotion = ConfigurableJointMotion.Locked,
            ZMotion = ConfigurableJointMotion.Locked,
            AngularXMotion = ConfigurableJointMotion.Locked,
            AngularYMotion = isY ? ConfigurableJointMotion.Limited : ConfigurableJointMotion.Locked,
            AngularZMotion = isY ? ConfigurableJointMotion.Locked : ConfigurableJointMotion.Limited,
            AngularYLimit = new SoftJointLimit { Limit = limit, Bounciness = bounciness },
            AngularZLimit = new SoftJointLimit { Limit = limit },
        };
        World world = SmallScene.Create(joint, Body with { MaxAngularVelocity = 1000 }, solver: SolverKind.Exact);
        world.Bodies[0].AngularVelocity = SmallScene.OwnPose.Rotation * (isY ? new Vector3d(0, 900, 0) : new Vector3d(0, 0, 900));
        double most = 0;

        for (int i = 0; i < 50; i++)
        {
            world.Step(SmallScene.Dt);
            most = Math.Max(most, Math.Abs(world.Joints[0].Coordinate(isY ? Coordinate.AngularY : Coordinate.AngularZ)));
        }

        Assert.That(most, Is.LessThanOrEqualTo(limit + 1e-6));
        Assert.That(world.Stops, Is.Zero);
    }

    [TestCase(-180, 180)]
    [TestCase(-180, 90)]
    [TestCase(-60, 180)]
    public void Twist_AgainstAStopAtHalfATurn_Holds(double low, double high)
    {
        var joint = new ConfigurableJoint
        {
            XMotion = ConfigurableJointMotion.Locked,
            YMotion = ConfigurableJointMotion.Locked,
            ZMotion = ConfigurableJointMotion.Locked,
            AngularXMotion = ConfigurableJointMotion.Limited,
            AngularYMotion = ConfigurableJointMotion.Locked,
            AngularZMotion = ConfigurableJointMotion.Locked,
            LowAngularXLimit = new SoftJointLimit { Limit = low },
            HighAngularXLimit = new SoftJointLimit { Limit = high },
        };
        World world = SmallScene.Create(joint, Body, solver: SolverKind.Exact);
        double end = Math.Abs(low) == 180 ? low : high;
        world.Bodies[0].AngularVelocity = SmallScene.OwnPose.Rotation * new Vector3d(-Math.Sign(end) * 4, 0, 0);

        double farthest = 0;
        for (int i = 0; i < 300; i++)
        {
            world.Step(SmallScene.Dt);
            farthest = Math.Max(farthest, Math.Abs(world.Joints[0].Coordinate(Coordinate.AngularX)));
        }

        Assert.That(farthest, Is.EqualTo(180).Within(1e-5));
        Assert.That(world.Stops, Is.Zero);
    }

    /// <summary>A pendulum let go beside the upper dead point falls on a stop there from the other side.</summary>
    [TestCase(-180, 180, -1)]
    [TestCase(-180, 180, 1)]
    [TestCase(-180, 0, -1)]
    public void Pendulum_WithAStopAtHalfATurn_KeepsItsEnergyUntilItHits(double min, double max, double push)
    {
        var hinge = new HingeJoint { Axis = Vector3d.UnitZ, Anchor = new Vector3d(0, 0.5, 0), UseLimits = true, Limits = new JointLimits { Min = min, Max = max } };
        SceneDocument document = SmallScene.Document(hinge, Body, connected: false);
        GameObject own = document.GameObjects[0];
        var upright = new GameObject { Id = own.Id, Name = own.Name, Components = own.Components };
        World world = World.Create(SmallScene.Validate(new SceneDocument { GameObjects = [upright] }), SolverKind.Exact);
        world.Bodies[0].AngularVelocity = new Vector3d(0, 0, push * 9);
        world.Bodies[0].LinearVelocity = Vector3d.Cross(world.Bodies[0].AngularVelocity, new Vector3d(0, -0.5, 0));

        double highest = world.KineticEnergy + world.PotentialEnergy;
        double start = highest;
        double farthest = 0;
        for (int i = 0; i < 1000; i++)
        {
            world.Step(0.02);
            farthest = Math.Max(farthest, Math.Abs(world.Joints[0].Coordinate(Coordinate.Angle)));
            highest = Math.Max(highest, world.KineticEnergy + world.PotentialEnergy);
        }

        Assert.That(farthest, Is.EqualTo(180).Within(1e-5), "it reaches the stop");
        Assert.That(highest, Is.LessThan(start + 0.02 * (start + 10)));
        Assert.That((world.Stops, world.Findings.Diagnostics.Count), Is.EqualTo((0, 0)));
    }

    /// <summary>A light body in a small disc, thrown about by a heavy one that hangs on it freely: the rim is passed within a step.</summary>
    [Test]
    public void Disc_WithAHeavyBodyOnIt_GainsNoEnergyAtItsRim([Values(0.002, 0.0134506)] double radius)
    {
        var disc = new ConfigurableJoint
        {
            Axis = new Vector3d(0.33, -0.42, 0.1),
            SecondaryAxis = new Vector3d(0.244, 0.711, -0.389),
            XMotion = ConfigurableJointMotion.Limited,
            YMotion = ConfigurableJointMotion.Locked,
            ZMotion = ConfigurableJointMotion.Limited,
            LinearLimit = new SoftJointLimit { Limit = radius },
        };
        var hanger = new ConfigurableJoint
        {
            Axis = new Vector3d(-0.4, 0.7, 0.8),
            Anchor = new Vector3d(0.4, -0.15, -0.12),
            YMotion = ConfigurableJointMotion.Locked,
            AngularZMotion = ConfigurableJointMotion.Locked,
            ConnectedBody = 0,
        };
        GameObject light = new() { Id = "light", Name = "light", Components = [new Rigidbody { Mass = 0.1, CenterOfMass = new Vector3d(-0.08, 0.06, -0.2) }, disc] };
        GameObject heavy = new() { Id = "heavy", Name = "heavy", Transform = SmallScene.At(SmallScene.OwnPose), Components = [new Rigidbody { Mass = 30 }, hanger] };
        World world = World.Create(SmallScene.Validate(new SceneDocument { GameObjects = [light, heavy] }), SolverKind.Exact);

        double highest = world.KineticEnergy + world.PotentialEnergy;
        double scale = 0;
        for (int i = 0; i < 200; i++)
        {
            world.Step(0.02);
            double energy = world.KineticEnergy + world.PotentialEnergy;
            scale = Math.Max(scale, world.KineticEnergy);
            Assert.That(energy, Is.LessThan(highest + 1e-3 * scale), $"step {i}");
            highest = Math.Max(highest, energy);
        }

        Assert.That(world.Stops, Is.Zero);
    }

    [Test]
    public void Limits_ThatContradict_AreNamedAndThePairFallsOn()
    {
        HingeJoint Hinge(double min, double max) => new() { Axis = Vector3d.UnitZ, ConnectedBody = 0, Anchor = new Vector3d(0.1, 0.2, 0.3), UseLimits = true, Limits = new JointLimits { Min = min, Max = max } };
        GameObject first = new() { Id = "first", Name = "first", Components = [Body] };
        GameObject second = new() { Id = "second", Name = "second", Components = [Body, Hinge(10, 20), Hinge(-20, -10)] };
        World world = World.Create(SmallScene.Validate(new SceneDocument { GameObjects = [first, second] }), SolverKind.Exact);

        for (int i = 0; i < 50; i++)
        {
            world.Step(0.02);
        }

        Diagnostic found = world.Findings.Diagnostics.Single();
        Assert.That((found.Code, found.Severity, found.Pointer), Is.EqualTo((DiagnosticCodes.LimitsContradict, Severity.Warning, "/gameObjects/1/components/1")));
        Assert.That(found.Message, Does.Contain("second[1] (by 10 degrees), second[2] (by 10 degrees)"));
        Assert.That(world.Stops, Is.Zero);
        Assert.That(world.Bodies[0].Pose.Position.Y, Is.EqualTo(-9.81 / 2).Within(1e-9), "free fall for a second");
        Assert.That(world.Joints[0].Coordinate(Coordinate.Angle), Is.EqualTo(0).Within(1e-9));
    }

    [Test]
    public void Limits_ChangedSoThatTheJointIsBeyond_MoveItInside()
    {
        World world = SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ }, Body, solver: SolverKind.Exact);
        var hinge = (WorldHingeJoint)world.Joints[0];
        hinge.DriveTo(Coordinate.Angle, 40);
        SmallScene.Run(world, 3);

        hinge.Settings = hinge.Settings with { UseLimits = true, Limits = new JointLimits { Min = -10, Max = 25 } };
        SmallScene.Run(world, 0.1);

        Assert.That(hinge.Coordinate(Coordinate.Angle), Is.EqualTo(25).Within(1e-6));
        Assert.That(world.Findings.Diagnostics.Select(d => d.Code), Is.EqualTo(new[] { DiagnosticCodes.StartClosed }));
    }
}
