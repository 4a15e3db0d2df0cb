using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;
using Kinefab.Tests.Kinematics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>A world that has come back to a state goes the same way again, to the last bit.</summary>
public sealed class SnapshotTests
{
    private static string Fixture(string name) => Path.Combine(Scenario.Folder, "..", "..", "fixtures", name);

    // A lever with drives and limits, gears, a screw, springs of an over-constrained loop, balls.
    private static readonly string[] Files =
        ["lever/lever.kinefab", "mechanisms/M01.kinefab", "mechanisms/M24.kinefab", "mechanisms/M25.kinefab", "mechanisms/M19.kinefab", "mechanisms/M44.kinefab", "hinge_slider_yup/hinge_slider.kinefab"];

    [Test, Combinatorial]
    public void Restore_InTheMiddle_GivesTheSameBits([ValueSource(nameof(Files))] string file, [Values] SolverKind solver)
    {
        World world = World.Load(Fixture(file), solver);
        WorldJoint? driven = world.Joints.FirstOrDefault(joint => joint.FreeCoordinates.Count > 0);
        driven?.DriveAt(driven.FreeCoordinates[0], 13);
        world.Bodies[^1].AddForce(new Vector3d(0.3, -0.2, 0.1));
        Steps(world, 37);
        WorldSnapshot snapshot = world.Snapshot();
        List<long> first = Bits(world, 40);
        for (int again = 0; again < 2; again++)
        {
            world.Restore(snapshot);
            Assert.That(world.Time, Is.EqualTo(snapshot.Time));
            Assert.That(Bits(world, 40), Is.EqualTo(first));
        }
    }

    // Side by side in lanes, some of them too fast for a plain step; with an odd one left over.
    [Test, Combinatorial]
    public void Restore_OfManyAlike_GivesTheSameBits([Values(3, 11)] int count, [Values] SolverKind solver)
    {
        var scene = new MechanismScene();
        for (int i = 0; i < count; i++)
        {
            int upper = scene.Body($"upper{i}", new Vector3d(2 * i, 1, 0));
            int lower = scene.Body($"lower{i}", new Vector3d(2 * i, 0.4, 0.1));
            scene.Hinge(upper, null, new Vector3d(2 * i, 1.5, 0), new Vector3d(0.2, 0, 1));
            scene.Hinge(lower, upper, new Vector3d(2 * i, 0.7, 0), new Vector3d(0, 0.1, 1));
        }

        World world = World.Create(new ValidScene(scene.Document()), solver);
        for (int i = 0; i < world.Bodies.Count; i++)
            world.Bodies[i].AngularVelocity = new Vector3d(0.1 * i, 0, i % 5 == 0 ? 60 : 1);
        Steps(world, 23);
        WorldSnapshot snapshot = world.Snapshot();
        List<long> first = Bits(world, 30);
        world.Restore(snapshot);
        Assert.That(Bits(world, 30), Is.EqualTo(first));
    }

    // A loop that steps alone takes its matrix over from the step before, and with it what the rows answer, by which rows that work against each
    // other are told apart.
    [Test]
    public void Restore_OfCoupledSlidesBetweenEnds_GivesTheSameBits([Values] SolverKind solver)
    {
        var scene = new MechanismScene();
        int upper = scene.Body("upper", new Vector3d(0.1, 1, 0));
        int lower = scene.Body("lower", new Vector3d(0.3, 0.4, 0.1));
        var first = scene.Configurable(upper, null, new Vector3d(0.2, 1.5, 0), new Vector3d(0.2, 1, 0.3), Vector3d.UnitX, "MLLLLL", 100);
        var second = scene.Configurable(lower, upper, new Vector3d(0.5, 0.7, 0.1), new Vector3d(1, 0.1, 0), Vector3d.UnitY, "MLLLLL", 100);
        scene.Couple(first, Coordinate.X, second, Coordinate.X, 0.6);
        World world = World.Create(new ValidScene(scene.Document()), solver);
        foreach (WorldBody body in world.Bodies)
            body.Settings = body.Settings with { InertiaTensor = new Vector3d(0.01, 0.02, 0.015) };
        Steps(world, 7);
        WorldSnapshot snapshot = world.Snapshot();
        List<long> after = Bits(world, 20);
        world.Restore(snapshot);
        Assert.That(Bits(world, 20), Is.EqualTo(after));
    }

    [Test]
    public void Restore_OfAStateWhoseSettingsNoStepHasSeen_GivesTheSameBits([Values] SolverKind solver)
    {
        World world = World.Load(Fixture("lever/lever.kinefab"), solver);
        Steps(world, 12);
        var hinge = (WorldHingeJoint)world.Joints[0];
        hinge.Settings = hinge.Settings with { UseLimits = true, Limits = hinge.Settings.Limits with { Min = -10, Max = 80 }, UseSpring = true, Spring = new JointSpring { Spring = 3, Damper = 0.1, TargetPosition = 40 } };
        world.Bodies[1].Settings = world.Bodies[1].Settings with { Mass = 7.5 };
        WorldSnapshot snapshot = world.Snapshot();
        List<long> first = Bits(world, 30);
        world.Restore(snapshot);
        Assert.That(Bits(world, 30), Is.EqualTo(first));
    }

    [Test]
    public void Snapshot_Taken_ChangesNoBit([Values] SolverKind solver)
    {
        World watched = World.Load(Fixture("lever/lever.kinefab"), solver);
        World left = World.Load(Fixture("lever/lever.kinefab"), solver);
        Steps(watched, 20);
        Steps(left, 20);
        watched.Snapshot();
        Assert.That(Bits(watched, 30), Is.EqualTo(Bits(left, 30)));
    }

    [Test]
    public void Restore_BehindChanges_BringsSettingsAndDrivesBack([Values] SolverKind solver)
    {
        World world = World.Load(Fixture("lever/lever.kinefab"), solver);
        var hinge = (WorldHingeJoint)world.Joints[0];
        Steps(world, 10);
        WorldSnapshot snapshot = world.Snapshot();
        List<long> first = Bits(world, 20);
        hinge.Settings = hinge.Settings with { UseLimits = true, Limits = hinge.Settings.Limits with { Min = -10, Max = 80 } };
        hinge.DriveTo(Coordinate.Angle, 55);
        world.Gravity = new Vector3d(0, 0, -3);
        world.Bodies[1].Settings = world.Bodies[1].Settings with { Mass = 7.5, InertiaTensor = new Vector3d(1, 2, 3) };
        Steps(world, 15);
        world.Restore(snapshot);
        Assert.That(hinge.Settings.Limits.Max, Is.Not.EqualTo(80));
        Assert.That(Bits(world, 20), Is.EqualTo(first));
    }

    [Test]
    public void Restore_BehindABreak_MakesTheJointWholeAgain([Values] SolverKind solver)
    {
        World world = SmallScene.Create(new FixedJoint { BreakForce = 5 }, solver: solver);
        int breaks = 0;
        world.JointBroken += (_, _) => breaks++;
        WorldSnapshot snapshot = world.Snapshot();
        for (int again = 1; again <= 2; again++)
        {
            world.Bodies[0].AddForce(new Vector3d(0, -40, 0));
            world.Step(SmallScene.Dt);
            Assert.That(world.Joints[0].IsBroken, Is.True);
            Assert.That(breaks, Is.EqualTo(again));
            world.Restore(snapshot);
            Assert.That(world.Joints[0].IsBroken, Is.False);
        }
    }

    [Test]
    public void Restore_OfTurns_CountsThemOn([Values] SolverKind solver)
    {
        World world = SmallScene.Create(new HingeJoint(), solver: solver);
        world.DriveAt("own", 720);
        world.Run(1.3, step: SmallScene.Dt);
        WorldSnapshot snapshot = world.Snapshot();
        double before = world["own"];
        world.Run(1, step: SmallScene.Dt);
        world.Restore(snapshot);
        Assert.That(world["own"], Is.EqualTo(before).And.GreaterThan(800));
    }

    [Test]
    public void Restore_OfAnotherWorld_IsRefused()
    {
        WorldSnapshot other = SmallScene.Create(new HingeJoint()).Snapshot();
        Assert.That(() => SmallScene.Create(new HingeJoint()).Restore(other), Throws.ArgumentException);
        Assert.That(() => SmallScene.Create(new HingeJoint()).Restore(null!), Throws.InstanceOf<ArgumentNullException>());
    }

    [TestCase(typeof(RevoluteJoint))]
    [TestCase(typeof(D6Joint))]
    [TestCase(typeof(Kinefab.Joints.JointModel))]
    public void TakeOver_EveryField_IsTaken(Type type)
    {
        Type made = type.IsAbstract ? typeof(D6Joint) : type;
        foreach (FieldInfo field in made.GetFields(BindingFlags.Public | BindingFlags.Instance))
        {
            var from = (JointModel)Activator.CreateInstance(made)!;
            var to = (JointModel)Activator.CreateInstance(made)!;
            field.SetValue(from, Other(field.GetValue(from)!));
            to.TakeOver(from);
            Assert.That(field.GetValue(to), Is.EqualTo(field.GetValue(from)), field.Name);
            Assert.That(field.GetValue(to), Is.Not.EqualTo(field.GetValue(Activator.CreateInstance(made))), field.Name);
        }
    }

    private static object Other(object value) => value switch
    {
        bool flag => !flag,
        int number => number + 1,
        double number => double.IsFinite(number) ? number + 1 : 3,
        AxisMotion motion => motion == AxisMotion.Free ? AxisMotion.Limited : AxisMotion.Free,
        Pose => new Pose(new Vector3d(1, 2, 3), Quaterniond.AxisAngle(Vector3d.UnitY, 0.3)),
        Vector3d => new Vector3d(1, 2, 3),
        _ => Changed(value),
    };

    private static object Changed(object value)
    {
        FieldInfo first = value.GetType().GetFields(BindingFlags.Public | BindingFlags.Instance).First(f => f.FieldType == typeof(double));
        first.SetValue(value, (double)first.GetValue(value)! + 1);
        return value;
    }

    private static void Steps(World world, int count)
    {
        for (int i = 0; i < count; i++)
            world.Step(0.013);
    }

    private static List<long> Bits(World world, int steps)
    {
        var bits = new List<long>();
        for (int i = 0; i < steps; i++)
        {
            world.Step(0.013);
            foreach (WorldBody body in world.Bodies)
            {
                Pose pose = body.Pose;
                foreach (double number in new[] { pose.Position.X, pose.Position.Y, pose.Position.Z, pose.Rotation.X, pose.Rotation.Y, pose.Rotation.Z, pose.Rotation.W, body.LinearVelocity.X, body.LinearVelocity.Y, body.AngularVelocity.Z })
                    bits.Add(BitConverter.DoubleToInt64Bits(number));
            }

            foreach (WorldJoint joint in world.Joints)
            {
                bits.Add(BitConverter.DoubleToInt64Bits(joint.CurrentForce.X));
                bits.AddRange(joint.FreeCoordinates.Select(c => BitConverter.DoubleToInt64Bits(joint.Coordinate(c))));
            }
        }

        return bits;
    }
}
