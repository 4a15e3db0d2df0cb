using System;
using System.Linq;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>A pose that stands open is closed before the first step, and no speed comes of it.</summary>
internal sealed class PositionProjectionTests
{
    private const double Dt = 1.0 / 60;

    [Test]
    public void Step_StartOpen_ClosesWithoutGain(
        [Values("pendulum", "chain", "fourbar")] string scene, [Values(0, 1e-3, 0.1, 1, 3)] double gap, [Values(0, 30, 90, 170)] double degrees)
    {
        MultibodySystem m = Make(scene);
        bool isOpen = gap > 0 || degrees > 0;
        Displace(m, gap, degrees);
        Vector3d before = m.Bodies.Poses[m.Bodies.Count / 2].Position;
        var solver = new RattleSolver(m);

        solver.Step(Dt);

        Assert.That(MechanismMeasures.Drift(m), Is.LessThanOrEqualTo(1e-8));
        Assert.That(AxesApart(m), Is.LessThanOrEqualTo(1e-8));
        Assert.That(m.Stops, Is.Zero);
        Assert.That(m.Closed, Has.Count.EqualTo(isOpen ? 1 : 0));

        // Everything was at rest: what moves now fell for one step at most.
        Assert.That(MechanismMeasures.Kinetic(m), Is.LessThanOrEqualTo(MechanismMeasures.FallEnergy(m, Dt)));
        if (isOpen)
        {
            Assert.That(m.Closed[0].Distance, Is.GreaterThanOrEqualTo((m.Bodies.Poses[m.Bodies.Count / 2].Position - before).Length - 0.01));
            solver.Step(Dt);
            Assert.That(m.Closed, Is.Empty);
        }
    }

    /// <summary>
    /// Limits that a move would pass have to hold in it too: with those alone that are passed before it they took turns, and 7 of these 27 poses stayed open.
    /// </summary>
    [Test]
    public void Step_LooseTiesPassed_ClosesWithoutGain([Values(2, 3, 4)] int ties, [Values(0.03, 0.1, 0.3)] double gap, [Values(10, 30, 57)] double degrees)
    {
        (Vector3d Place, double Play)[] all =
        {
            (new Vector3d(0.9, -0.2, 0.1), 0.02), (new Vector3d(-0.6, 0.5, -0.3), 0.005), (new Vector3d(0.1, -0.8, 0.6), 0.08), (new Vector3d(-0.2, 0.3, 0.9), 4e-4),
        };
        var b = new MechanismBuilder();
        int body = b.Body(Vector3d.Zero, Quaterniond.Identity, 1, new Vector3d(0.1, 0.2, 0.25));
        for (int i = 0; i < ties; i++)
        {
            var tie = new D6Joint
            {
                X = AxisMotion.Limited, Y = AxisMotion.Limited, Z = AxisMotion.Limited, Twist = AxisMotion.Free, Swing1 = AxisMotion.Free, Swing2 = AxisMotion.Free,
                LinearLimit = new LinearLimit { Value = all[i].Play },
            };
            b.Add(tie, JointModel.World, body, all[i].Place, Vector3d.UnitX);
        }

        MultibodySystem m = b.Build();
        Displace(m, gap, degrees);
        var solver = new RattleSolver(m);

        solver.Step(Dt);

        foreach ((Vector3d place, double play) in all.Take(ties))
        {
            Assert.That((m.Bodies.Poses[0].Point(place) - place).Length, Is.LessThanOrEqualTo(play + 1e-8));
        }

        Assert.That(m.Stops, Is.Zero);
        Assert.That(MechanismMeasures.Kinetic(m), Is.LessThanOrEqualTo(MechanismMeasures.FallEnergy(m, Dt)));
    }

    [Test]
    public void Step_TeleportedWhileTurning_GainsNothingButHeight([Values(0.1, 3)] double gap, [Values(0, 90)] double degrees)
    {
        MultibodySystem m = Make("chain");
        var solver = new RattleSolver(m);
        for (int i = 0; i < 60; i++)
        {
            solver.Step(Dt);
        }

        Displace(m, gap, degrees);
        double kinetic = MechanismMeasures.Kinetic(m);
        double share = Math.Sqrt(kinetic) + Math.Sqrt(MechanismMeasures.FallEnergy(m, Dt));
        solver.Step(Dt);

        // Speeds may only add to what they were what one step of falling gives.
        Assert.That(MechanismMeasures.Kinetic(m), Is.LessThanOrEqualTo(share * share));
        Assert.That(MechanismMeasures.Drift(m), Is.LessThanOrEqualTo(1e-8));
        Assert.That(m.Stops, Is.Zero);
    }

    [Test]
    public void Step_PlacesAtOdds_MoveNothingAndSaySo()
    {
        // Held to the world where it stands, and by a second joint to a place 5 m away.
        var b = new MechanismBuilder();
        int body = b.Body(Vector3d.Zero, Quaterniond.Identity, 1, new Vector3d(1, 1, 1));
        b.Add(new D6Joint(), JointModel.World, body, Vector3d.Zero, Vector3d.UnitX);
        D6Joint far = b.Add(new D6Joint(), JointModel.World, body, Vector3d.Zero, Vector3d.UnitX);
        far.Frame0 = new Pose(new Vector3d(5, 0, 0), far.Frame0.Rotation);
        MultibodySystem m = b.Build();

        new RattleSolver(m).Step(Dt);

        Assert.That(m.Closed, Is.Empty);
        Assert.That(m.Unsolved, Has.Count.EqualTo(1));
        Assert.That(m.Bodies.Poses[0].Position.Length, Is.LessThan(1e-9));
    }

    [Test]
    public void Step_OpenAmongClosed_IsTheSameInLanesAndAlone()
    {
        MultibodySystem lanes = SolverScenes.FourBars(5);
        MultibodySystem alone = SolverScenes.FourBars(5);
        Displace(lanes, 0.1, 30);
        Displace(alone, 0.1, 30);

        new RattleSolver(lanes).Step(Dt);
        new RattleSolver(alone, 1).Step(Dt);

        Assert.That(lanes.Closed, Has.Count.EqualTo(1));
        Assert.That(MechanismMeasures.Bits(lanes), Is.EqualTo(MechanismMeasures.Bits(alone)));
    }

    private static MultibodySystem Make(string scene)
    {
        if (scene != "pendulum")
        {
            return scene == "chain" ? SolverScenes.Chain(8) : SolverScenes.FourBars(1);
        }

        var b = new MechanismBuilder();
        int bar = b.Bar(Vector3d.Zero, Vector3d.UnitX, 1);
        b.Hinge(JointModel.World, bar, Vector3d.Zero, Vector3d.UnitZ);
        return b.Build();
    }

    // As a program would that writes a pose: out of the joint's plane and about an axis of none.
    private static void Displace(MultibodySystem m, double gap, double degrees)
    {
        int body = m.Bodies.Count / 2;
        Pose pose = m.Bodies.Poses[body];
        m.Bodies.Poses[body] = new Pose(
            pose.Position + gap * new Vector3d(0.6, 0.48, 0.64), Quaterniond.AxisAngle(new Vector3d(0.6, 0, 0.8), degrees * Math.PI / 180) * pose.Rotation);
    }

    private static double AxesApart(MultibodySystem m)
    {
        double most = 0;
        foreach (JointModel joint in m.Joints)
        {
            Vector3d axis0 = m.Bodies.PoseOf(joint.Body0).Rotation * (joint.Frame0.Rotation * Vector3d.UnitX);
            Vector3d axis1 = m.Bodies.PoseOf(joint.Body1).Rotation * (joint.Frame1.Rotation * Vector3d.UnitX);
            most = joint is RevoluteJoint ? Math.Max(most, (axis0 - axis1).Length) : most;
        }

        return most;
    }
}
