using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>When steps are cut, for how long, and what is counted when no method can take one.</summary>
internal sealed class StepControllerTests
{
    [Test]
    public void Record_HarderStep_IsKept()
    {
        SubstepHistory cut = default(SubstepHistory);
        cut.Record(3, 5);
        Assert.That(cut.Halvings, Is.EqualTo(3));
        cut.Record(3, 0.1);
        Assert.That(cut.Halvings, Is.EqualTo(3));
    }

    [Test]
    public void Record_FifteenCalmSteps_OneHalvingLess()
    {
        SubstepHistory cut = default(SubstepHistory);
        cut.Record(3, 5);
        for (int i = 0; i < 14; i++)
        {
            cut.Record(3, 1);
        }

        Assert.That(cut.Halvings, Is.EqualTo(3));
        cut.Record(3, 1);
        Assert.That(cut.Halvings, Is.EqualTo(2));
    }

    [Test]
    public void Record_DemandAmongCalmSteps_CountsAnew()
    {
        SubstepHistory cut = default(SubstepHistory);
        cut.Record(3, 5);
        for (int i = 0; i < 14; i++)
        {
            cut.Record(3, 1);
        }

        cut.Record(3, 1.5);
        for (int i = 0; i < 14; i++)
        {
            cut.Record(3, 1);
        }

        Assert.That(cut.Halvings, Is.EqualTo(3));
    }

    [TestCase(8, 0, 0.25, 0.5)]
    [TestCase(0, 10, 0.1, 2)]
    [TestCase(20000, 10, 0.1, 10)]
    public void StepLimit_OfStiffnessAndSpeed_IsTheLarger(double stiffness, double speed, double dt, double expected)
    {
        Assert.That(StepLimit.Of(stiffness, speed, dt), Is.EqualTo(expected).Within(1e-12));
    }

    [Test]
    public void Step_LoopThatCannotClose_StandsAndSaysSo()
    {
        // A bar of 1 m pinned to the world at two points 1.5 m apart.
        var b = new MechanismBuilder();
        int bar = b.Bar(Vector3d.Zero, Vector3d.UnitX, 1);
        b.Hinge(JointModel.World, bar, Vector3d.Zero, Vector3d.UnitZ);
        RevoluteJoint far = b.Hinge(JointModel.World, bar, Vector3d.UnitX, Vector3d.UnitZ);
        far.Frame0 = new Pose(new Vector3d(1.5, 0, 0), far.Frame0.Rotation);
        MultibodySystem mechanism = b.Build();
        var solver = new RattleSolver(mechanism);
        Pose start = mechanism.Bodies.Poses[0];
        for (int i = 0; i < 10; i++)
        {
            solver.Step(0.02);
        }

        Assert.That(mechanism.Stops, Is.Positive);
        Assert.That(mechanism.Unsolved, Has.Count.EqualTo(1));
        Assert.That(mechanism.Bodies.Poses[0], Is.EqualTo(start));
        Assert.That(mechanism.Bodies.LinearVelocities[0].Length, Is.LessThan(1));
    }

    [Test]
    public void Step_HeavyChainAtRest_IsCutByItsDemandAlone()
    {
        var b = new MechanismBuilder();
        int last = JointModel.World;
        for (int i = 0; i < 4; i++)
        {
            int bar = b.Bar(new Vector3d(0, -0.2 * i, 0), new Vector3d(0, -0.2 * (i + 1), 0), i == 3 ? 20 : 0.1);
            b.Hinge(last, bar, new Vector3d(0, -0.2 * i, 0), Vector3d.UnitZ);
            last = bar;
        }

        (int halvings, double demand, _) = HalvingsAfter(b.Build(), 1.0 / 60, 40);
        Assert.That(demand, Is.GreaterThan(1));
        Assert.That(1 << halvings, Is.InRange(demand, 2 * demand));
    }

    [Test]
    public void Step_LimitsReachedInTurn_NeedNoCut()
    {
        var b = new MechanismBuilder();
        int upper = b.Bar(Vector3d.Zero, Vector3d.UnitX, 1);
        int lower = b.Bar(Vector3d.UnitX, Vector3d.UnitX * 2, 1);
        foreach (RevoluteJoint hinge in new[] { b.Hinge(JointModel.World, upper, Vector3d.Zero, Vector3d.UnitZ), b.Hinge(upper, lower, Vector3d.UnitX, Vector3d.UnitZ) })
        {
            hinge.LimitEnabled = true;
            hinge.Limit = new AngularLimit { Lower = -0.4, Upper = 0.2 };
        }

        Assert.That(HalvingsAfter(b.Build(), 1.0 / 60, 60).Halvings, Is.Zero);
    }

    /// <summary>Bounces without end, each shorter than the one before, would fill the first step after a lever has come to its stop with parts.</summary>
    [Test]
    public void Step_BouncesThatDieOut_ComeToRest()
    {
        var b = new MechanismBuilder();
        int lever = b.Bar(Vector3d.Zero, Vector3d.UnitX, 1);
        RevoluteJoint hinge = b.Hinge(JointModel.World, lever, Vector3d.Zero, Vector3d.UnitZ);
        hinge.LimitEnabled = true;
        hinge.Limit = new AngularLimit { Lower = -0.02, Upper = 1, Response = new LimitResponse { Restitution = 0.75 } };
        MultibodySystem m = b.Build();
        Assert.That(HalvingsAfter(m, 1.0 / 60, 60).Tries, Is.LessThanOrEqualTo(9));
        Assert.That(m.Bodies.AngularVelocities[0].Length, Is.Zero.Within(1e-9));
    }

    /// <summary>
    /// Two ranges that no angle satisfies, both passed and both left or driven further by the speed: the one that its joint left was taken for apart and
    /// passed at once, and a step took 280 parts.
    /// </summary>
    [Test]
    public void Step_LimitsThatContradict_CostsAPart()
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int lever = b.Bar(Vector3d.Zero, Vector3d.UnitX, 1);
        b.Change(lever, d => d with { AngularVelocity = new Vector3d(0, 0, 0.5), LinearVelocity = new Vector3d(0, 0.25, 0) });
        foreach (double lower in new[] { 0.1, -1 })
        {
            RevoluteJoint hinge = b.Hinge(JointModel.World, lever, Vector3d.Zero, Vector3d.UnitZ);
            hinge.LimitEnabled = true;
            hinge.Limit = new AngularLimit { Lower = lower, Upper = lower + 0.9, Response = new LimitResponse { Restitution = 0.5 } };
        }

        Assert.That(HalvingsAfter(b.Build(), 1.0 / 60, 3).Tries, Is.EqualTo(1));
    }

    [Test]
    public void Step_FloatingRing_IsHeldAsALoop()
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        // Nothing round, so that no rounding cancels.
        Vector3d[] corners = { new(0.03, 0.01, 0.2), new(1.1, 0.17, 0.2), new(1.31, 1.13, 0.2), new(0.07, 0.89, 0.2) };
        var spin = new Vector3d(0.31, 0.17, 1.1);
        for (int i = 0; i < 4; i++)
        {
            b.Change(b.Bar(corners[i], corners[(i + 1) % 4], 1), d =>
            {
                d.AngularVelocity = spin;
                d.LinearVelocity = Vector3d.Cross(spin, d.Pose.Position - corners[0]);
                return d;
            });
        }

        for (int i = 0; i < 4; i++)
        {
            b.Hinge(i, (i + 1) % 4, corners[(i + 1) % 4], Vector3d.UnitZ);
        }

        MultibodySystem ring = b.Build();
        var solver = new RattleSolver(ring);
        for (int i = 0; i < 60; i++)
        {
            solver.Step(1.0 / 60);
            foreach (JointReaction reaction in ring.Reactions)
            {
                Assert.That(reaction.Force.Length, Is.LessThan(10));
                Assert.That(reaction.Torque.Length, Is.LessThan(10));
            }
        }

        Assert.That(MechanismMeasures.Drift(ring), Is.LessThanOrEqualTo(1e-8));
    }

    private static (int Halvings, double Demand, int Tries) HalvingsAfter(MultibodySystem mechanism, double dt, int steps)
    {
        foreach (JointModel joint in mechanism.Joints)
        {
            joint.LimitsFromAfar = true;
        }

        Island island = IslandFinder.Find(mechanism)[0];
        var batch = new LaneBatch<ScalarLane>(island, new Workspace<ScalarLane>(island));
        LaneTransfer<ScalarLane>.GatherConstants(batch, 0, island, mechanism);
        var controller = new StepController(batch);
        SubstepHistory cut = default(SubstepHistory);
        var still = new Standstill();
        double most = 0;
        int tries = 0;
        for (int i = 0; i < steps; i++)
        {
            LaneTransfer<ScalarLane>.Gather(batch, mechanism, dt);
            LaneTransfer<ScalarLane>.BeginStep(batch);
            FreeMotion<ScalarLane>.Stay(batch);
            RattleStep<ScalarLane>.Rebuild(batch);
            most = System.Math.Max(most, StepLimit.Of(StepLimit.Stiffest(batch, 0), batch.Work.Fastest[0], dt));
            controller.Advance(dt, 1e-9, ref cut, still, false, false);
            tries = System.Math.Max(tries, controller.Tries);
            LaneTransfer<ScalarLane>.EndStep(batch);
            LaneTransfer<ScalarLane>.Scatter(batch, 1, mechanism);
        }

        return (cut.Halvings, most, tries);
    }
}
