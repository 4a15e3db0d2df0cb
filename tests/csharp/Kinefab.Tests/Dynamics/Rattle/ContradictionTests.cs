using System;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using Kinefab.Tests.Kinematics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>
/// Drives without limit of force that cannot move as asked, and joints that stand apart: named, and at a step's cost. Two such motors against each
/// other took 280 parts a step, one on a frame that cannot move 8,000, a bar between pins that are too far apart searched anew in each step.
/// </summary>
internal sealed class ContradictionTests
{
    private const double Dt = 1.0 / 60;

    // Parts beyond the first, a step.
    private const double MostParts = 2;

    [TestCase(1, -1, float.MaxValue)]
    [TestCase(1, -3, float.MaxValue)]
    [TestCase(-2, 7, double.PositiveInfinity)]
    public void Motors_AgainstEachOther_StallAtThePriceOfAStep(double first, double second, double force)
    {
        var b = new MechanismBuilder();
        int bar = b.Bar(Vector3d.Zero, Vector3d.UnitX, 1);
        Motor(b.Hinge(JointModel.World, bar, Vector3d.Zero, Vector3d.UnitZ), first, force);
        Motor(b.Hinge(JointModel.World, bar, Vector3d.Zero, Vector3d.UnitZ), second, force);
        MultibodySystem m = b.Build();

        AssertCheap(m, 60);

        Assert.That(m.StalledJoints.Exists(joint => joint.IsDrive));
        Assert.That(m.Bodies.AngularVelocities[0].Z, Is.InRange(Math.Min(first, second) - 1e-6, Math.Max(first, second) + 1e-6));
    }

    [Test]
    public void Step_LimitsThatContradictInManyMechanisms_AreToldOnceAndCostNoWordsAfterwards()
    {
        static HingeJoint Limited(double min, double max) => new() { Axis = Vector3d.UnitZ, UseLimits = true, Limits = new JointLimits { Min = min, Max = max } };
        GameObject[] objects = [.. Enumerable.Range(0, 40).Select(i => new GameObject { Id = $"P{i}", Name = "P", Components = [new Rigidbody(), Limited(10, 20), Limited(-20, -10)] })];
        World world = World.Create(SmallScene.Validate(new SceneDocument { GameObjects = objects }), SolverKind.Exact);
        SmallScene.Run(world, 5 * SmallScene.Dt);
        long bytes = AllocatedBytes.LeastOf(() => world.Step(SmallScene.Dt));
        using (Assert.EnterMultipleScope())
        {
            Assert.That(world.Findings.Diagnostics.Count(found => found.Code == DiagnosticCodes.LimitsContradict), Is.EqualTo(10));
            Assert.That(bytes, Is.LessThan(1000));
        }
    }

    [Test]
    public void Motor_OnAFrameThatCannotMove_StallsAtThePriceOfAStep()
    {
        var b = new MechanismBuilder();
        var top = new Vector3d(0.3, 1, 0);
        int left = b.Bar(Vector3d.Zero, Vector3d.UnitX, 1);
        int right = b.Bar(Vector3d.UnitX, top, 1);
        Motor(b.Hinge(JointModel.World, left, Vector3d.Zero, Vector3d.UnitZ), 2, double.PositiveInfinity);
        b.Hinge(left, right, Vector3d.UnitX, Vector3d.UnitZ);
        b.Hinge(JointModel.World, right, top, Vector3d.UnitZ);
        MultibodySystem m = b.Build();

        AssertCheap(m, 30);

        Assert.That(m.StalledJoints.Select(joint => (joint.Joint, joint.IsDrive)), Is.EqualTo(new[] { (m.Joints[0], true) }));
        Assert.That(MechanismMeasures.Drift(m), Is.LessThanOrEqualTo(1e-8));
    }

    /// <summary>
    /// Two wheels geared 5 to 2 and a joint between them that is free about and along everything: along its Z the wheels' axles let nothing move, and no
    /// force at all is of use there. That drive took 280 parts a step; two more against each other through the gear, which tear at their axles, a thousand, of
    /// which the slower one acts now.
    /// </summary>
    [TestCase(double.NaN, MostParts)]
    [TestCase(114, MostParts)]
    public void Drives_OfGearsAndAlongWhatTheirAxlesHold_Stall(double other, double mostParts)
    {
        var s = new MechanismScene();
        int first = s.Body("first", Vector3d.Zero), second = s.Body("second", new Vector3d(0.7, 0, 0));
        Kinematics.JointPlace a = s.Hinge(first, null, Vector3d.Zero, Vector3d.UnitZ);
        Kinematics.JointPlace b = s.Hinge(second, null, new Vector3d(0.7, 0, 0), Vector3d.UnitZ);
        s.Configurable(second, first, new Vector3d(0.5, 0, 0), Vector3d.UnitX, Vector3d.UnitY, "FFFFFF");
        s.Couple(a, Coordinate.Angle, b, Coordinate.Angle, -0.4);
        World world = World.Create(SmallScene.Validate(s.Document()), SolverKind.Exact);
        world.Joints[1].DriveTo(Coordinate.Angle, -37);
        world.Joints[2].DriveAt(Coordinate.Z, 50);
        if (!double.IsNaN(other))
        {
            world.Joints[0].DriveTo(Coordinate.Angle, other);
        }

        for (int i = 0; i < 100; i++)
        {
            world.Step(0.02);
        }

        Assert.That(world.SubstepWork / 100, Is.LessThanOrEqualTo(mostParts * world.Joints.Count));
        Assert.That(world.Findings.Diagnostics.Select(found => found.Code).Distinct(), Is.EqualTo(new[] { DiagnosticCodes.DriveStalled }));
        Assert.That(world.Findings.Diagnostics[0].Message, Does.Contain("second[2] (drive)"));
        Assert.That(world.Stops, Is.Zero);
        if (double.IsNaN(other))
        {
            Assert.That(world.Joints[1].Coordinate(Coordinate.Angle), Is.EqualTo(-37).Within(1e-6));
        }
    }

    /// <summary>A motor of a light crank lifts whatever hangs on it: its force ends far above that.</summary>
    [TestCase(1e-3, 1e3)]
    [TestCase(1e-4, 1)]
    [TestCase(1, 1)]
    public void Motor_OfALightCrankWithAHeavyArm_KeepsItsSpeed(double crank, double arm)
    {
        var b = new MechanismBuilder();
        int light = b.Bar(Vector3d.Zero, 0.02 * Vector3d.UnitX, crank, 0.005);
        int heavy = b.Bar(0.02 * Vector3d.UnitX, 3 * Vector3d.UnitX, arm);
        Motor(b.Hinge(JointModel.World, light, Vector3d.Zero, Vector3d.UnitZ), 2, double.PositiveInfinity);
        b.Add(new D6Joint(), light, heavy, 0.02 * Vector3d.UnitX, Vector3d.UnitZ);
        MultibodySystem m = b.Build();
        var solver = new RattleSolver(m);
        for (int i = 0; i < 60; i++)
        {
            solver.Step(Dt);
            Assert.That(m.Bodies.AngularVelocities[heavy].Z, Is.EqualTo(2).Within(0.03), $"step {i}");
        }

        Assert.That((m.Stops, m.StalledJoints.Count), Is.EqualTo((0, 0)));
    }

    /// <summary>A spring of another joint is no bound of a drive without limit of force, however stiff it is.</summary>
    [TestCase(5e3)]
    [TestCase(5e7)]
    public void Drive_AgainstASpring_ArrivesAndHoldsIt(double stiffness)
    {
        var body = new Rigidbody { Mass = 1, InertiaTensor = new Vector3d(0.01, 0.02, 0.03), AngularDamping = 0, MaxAngularVelocity = 100 };
        var sprung = new HingeJoint { Axis = Vector3d.UnitZ, UseSpring = true, Spring = new JointSpring { Spring = stiffness, Damper = 1 } };
        GameObject own = new() { Id = "own", Name = "own", Components = [body, sprung, new HingeJoint { Axis = Vector3d.UnitZ }] };
        World world = World.Create(SmallScene.Validate(new SceneDocument { GameObjects = [own] }), SolverKind.Exact);
        world.Joints[1].DriveTo(Coordinate.Angle, 40);

        for (int i = 0; i < 250; i++)
        {
            world.Step(0.02);
        }

        Assert.That(world.Joints[0].Coordinate(Coordinate.Angle), Is.EqualTo(40).Within(1e-6));
        Assert.That((world.Stops, world.Findings.Diagnostics.Count), Is.EqualTo((0, 0)));
    }

    /// <summary>A motor without limit of force stops and turns round what spins.</summary>
    [Test]
    public void Motor_OfWhatSpins_TurnsItRound()
    {
        var b = new MechanismBuilder();
        int wheel = b.Bar(Vector3d.Zero, Vector3d.UnitX, 5);
        RevoluteJoint axle = b.Hinge(JointModel.World, wheel, Vector3d.Zero, Vector3d.UnitZ);
        Motor(axle, -70, float.MaxValue);
        MultibodySystem m = b.Build();
        m.Bodies.AngularVelocities[wheel] = 250 * Vector3d.UnitZ;
        m.Bodies.LinearVelocities[wheel] = Vector3d.Cross(m.Bodies.AngularVelocities[wheel], 0.5 * Vector3d.UnitX);
        var solver = new RattleSolver(m);

        for (int i = 0; i < 5; i++)
        {
            solver.Step(Dt);
            Assert.That(m.StalledJoints, Is.Empty);
        }

        Assert.That(m.Bodies.AngularVelocities[wheel].Z, Is.EqualTo(-70).Within(1e-3));
    }

    /// <summary>A motor of a body that cannot turn at all has no response to divide by: all other drives of its island were held with it, for good.</summary>
    [Test]
    public void Motor_OfWhatCannotTurn_HoldsNoOther()
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int slide = b.Body(Vector3d.Zero, Quaterniond.Identity, 1, new Vector3d(double.PositiveInfinity, double.PositiveInfinity, double.PositiveInfinity));
        int bar = b.Bar(Vector3d.Zero, Vector3d.UnitX, 1);
        Motor(b.Hinge(JointModel.World, slide, Vector3d.Zero, Vector3d.UnitZ), 0, double.PositiveInfinity);
        RevoluteJoint driven = b.Hinge(slide, bar, Vector3d.Zero, Vector3d.UnitZ);
        Motor(driven, 1, double.PositiveInfinity);
        driven.LimitEnabled = true;
        driven.Limit = new AngularLimit { Lower = -1, Upper = 0.5 };
        MultibodySystem m = b.Build();
        var solver = new RattleSolver(m);
        for (int i = 0; i < 60; i++)
        {
            solver.Step(Dt);
        }

        driven.Limit.Upper = 3;
        for (int i = 0; i < 60; i++)
        {
            solver.Step(Dt);
        }

        Assert.That(driven.Angle(m.Bodies.PoseOf(driven.Body0), m.Bodies.PoseOf(driven.Body1)), Is.GreaterThan(1));
    }

    /// <summary>A goal is met at a drift's end, and has to be looked at there, also of a hinge whose first body is the world: it stood at a third of the way.</summary>
    [Test]
    public void Goal_OfAHingeThatBeginsAtTheWorld_IsReached([Values] bool isWorldFirst)
    {
        var b = new MechanismBuilder();
        int arm = b.Bar(Vector3d.Zero, Vector3d.UnitX, 1);
        RevoluteJoint hinge = isWorldFirst
            ? b.Hinge(JointModel.World, arm, Vector3d.Zero, Vector3d.UnitZ)
            : b.Hinge(arm, JointModel.World, Vector3d.Zero, Vector3d.UnitZ);
        hinge.Spring = new DriveModel { Stiffness = 10, Damping = 1, ForceLimit = double.PositiveInfinity, Prescribes = Prescribed.Position };
        hinge.SpringTarget = 0.5;
        MultibodySystem m = b.Build();

        AssertCheap(m, 120);

        Assert.That(hinge.Angle(m.Bodies.PoseOf(hinge.Body0), m.Bodies.PoseOf(hinge.Body1)), Is.EqualTo(0.5).Within(1e-6));
    }

    [Test]
    public void Motors_AgainstEachOtherAndALimit_AreNamed()
    {
        var body = new Rigidbody { Mass = 1, InertiaTensor = new Vector3d(0.1, 0.1, 0.1), AngularDamping = 0, MaxAngularVelocity = 100 };
        HingeJoint Hinge(double speed, double max) => new()
        {
            Axis = Vector3d.UnitZ,
            UseMotor = speed != 0,
            Motor = new JointMotor { TargetVelocity = speed, Force = float.MaxValue },
            UseLimits = max < 180,
            Limits = new JointLimits { Min = -max, Max = max },
        };
        GameObject own = new() { Id = "own", Name = "own", Components = [body, Hinge(90, 180), Hinge(0, 30)] };
        World world = World.Create(SmallScene.Validate(new SceneDocument { GameObjects = [own] }), SolverKind.Exact);

        for (int i = 0; i < 100; i++)
        {
            world.Step(0.02);
        }

        Diagnostic found = world.Findings.Diagnostics.Single();
        Assert.That((found.Code, found.Pointer), Is.EqualTo((DiagnosticCodes.DriveStalled, "/gameObjects/0/components/1")));
        Assert.That(found.Message, Does.Contain("own[1] (drive), own[2] (limit)"));
        Assert.That(world.Joints[0].Coordinate(Coordinate.Angle), Is.EqualTo(30).Within(1e-5));
        Assert.That(world.Stops, Is.Zero);
    }

    /// <summary>A bar between a pin of the world and one that is carried out of its reach and back.</summary>
    [Test]
    public void Pins_CarriedApartAndBack_StandMeanwhileAndGoOn()
    {
        MultibodySystem m = CarriedPin();
        var solver = new RattleSolver(m);
        Drive(m, 2.6);
        solver.Step(Dt);
        Assert.That(m.Stops, Is.Positive);
        for (int i = 0; i < 20; i++)
        {
            solver.Step(Dt);
        }

        int stops = m.Stops;
        double work = m.SubstepWork;
        Pose stood = m.Bodies.Poses[0];
        solver.Step(Dt);
        Assert.That((m.Stops > stops, m.Unsolved.Count), Is.EqualTo((true, 1)), "it is said in each step");
        Assert.That(m.SubstepWork, Is.EqualTo(work), "and searched in the first alone");
        Assert.That(m.Bodies.Poses[0], Is.EqualTo(stood));

        Drive(m, 1.3);
        solver.Step(Dt);
        stops = m.Stops;
        for (int i = 0; i < 20; i++)
        {
            solver.Step(Dt);
        }

        Assert.That(m.Stops, Is.EqualTo(stops));
        Assert.That(MechanismMeasures.Drift(m), Is.LessThanOrEqualTo(1e-8));

        static void Drive(MultibodySystem m, double x) => m.Bodies.KinematicTargets[2] = new Pose(new Vector3d(x, 0, 0), m.Bodies.Poses[2].Rotation);
    }

    private static MultibodySystem CarriedPin()
    {
        var b = new MechanismBuilder();
        int bar = b.Bar(Vector3d.Zero, new Vector3d(0.6, 0.8, 0), 1);
        int other = b.Bar(new Vector3d(0.6, 0.8, 0), new Vector3d(1.2, 0, 0), 1);
        b.Hinge(JointModel.World, bar, Vector3d.Zero, Vector3d.UnitZ);
        b.Hinge(bar, other, new Vector3d(0.6, 0.8, 0), Vector3d.UnitZ);
        int carrier = b.Bar(new Vector3d(1.2, 0, 0), new Vector3d(1.4, 0, 0), 1);
        b.Change(carrier, d => d with { IsKinematic = true });
        b.Hinge(carrier, other, new Vector3d(1.2, 0, 0), Vector3d.UnitZ);
        return b.Build();
    }

    private static void Motor(RevoluteJoint hinge, double speed, double force)
    {
        hinge.MotorEnabled = true;
        hinge.MotorVelocity = speed;
        hinge.MotorForceLimit = force;
        hinge.DriveLimitsAreForces = true;
    }

    private static void AssertCheap(MultibodySystem m, int steps)
    {
        var solver = new RattleSolver(m);
        for (int i = 0; i < steps; i++)
        {
            double work = m.SubstepWork;
            solver.Step(Dt);
            Assert.That(m.SubstepWork - work, Is.LessThanOrEqualTo(MostParts * m.Joints.Length), $"step {i}");
        }

        Assert.That(m.Stops, Is.Zero);
    }
}
