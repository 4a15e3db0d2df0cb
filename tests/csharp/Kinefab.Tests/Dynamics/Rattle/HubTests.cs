using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Bodies of many joints stay in the matrix: what that saves, and that it changes nothing else.</summary>
public sealed class HubTests
{
    private const double Dt = 0.02;

    // Of a planar grid nothing is better than n log n and n^1.5 (George 1973).
    [TestCase("star", 1.05, 1.05)]
    [TestCase("pair", 1.05, 1.05)]
    [TestCase("comb", 1.05, 1.05)]
    [TestCase("grid", 1.35, 1.8)]
    public void Pattern_ManyJoints_HasAsManyNumbersAndOperations(string kind, double ofNumbers, double ofOperations)
    {
        (double numbers, double operations) small = Cost(kind, 512), large = Cost(kind, 4096);

        Assert.That(Math.Log(large.numbers / small.numbers, 8), Is.LessThan(ofNumbers), "numbers in the factor");
        Assert.That(Math.Log(large.operations / small.operations, 8), Is.LessThan(ofOperations), "multiplications to find it");
    }

    [TestCase("star", false)]
    [TestCase("star", true)]
    [TestCase("pair", false)]
    [TestCase("comb", false)]
    public void Solve_WithHubs_IsTheInverseOfTheOperator(string kind, bool isFrozen)
    {
        Island island = IslandOf(HubScenes.Kinds[kind](100), isFrozen, out MultibodySystem mechanism);
        Assert.That(island.Hubs, Is.Not.Empty);
        LaneBatch<ScalarLane> batch = Built(island, mechanism);
        DelassusMatrix<ScalarLane>.Assemble(batch, DelassusMatrix<ScalarLane>.AngularShare);
        DelassusMatrix<ScalarLane>.Factor(batch);

        // What some velocities ask for, so that rows that repeat each other ask for the same.
        var random = new Random(7);
        SetMomenta(batch, () => 2 * random.NextDouble() - 1);
        Impulses<ScalarLane>.NegativeSpeeds(batch);
        double[] right = [.. batch.Work.Solution], solution = [.. right];
        DelassusMatrix<ScalarLane>.Solve(batch, solution);

        SetMomenta(batch, () => 0);
        Impulses<ScalarLane>.Apply(batch, solution);
        Impulses<ScalarLane>.NegativeSpeeds(batch);
        double most = right.Max(Math.Abs);
        for (int i = 0; i < right.Length; i++)
        {
            double left = right[i] + batch.Work.Solution[i] - batch.Compliance[i] * solution[i];
            Assert.That(left, Is.Zero.Within(1e-10 * most), $"row {i}");
        }
    }

    [TestCase("star")]
    [TestCase("comb")]
    [TestCase("pair")]
    public void Step_ManyJoints_ClosesAndKeepsItsEnergy(string kind)
    {
        ValidScene scene = SmallScene.Validate(HubScenes.Kinds[kind](40));
        var world = World.Create(scene, SolverKind.Exact);
        double start = world.KineticEnergy + world.PotentialEnergy, most = 0;
        for (int i = 0; i < 100; i++)
        {
            world.Step(Dt / 4);
            most = Math.Max(most, world.KineticEnergy);
        }

        Assert.That(world.Stops, Is.Zero);
        Assert.That(most, Is.GreaterThan(kind == "pair" ? 1e-4 : 5), "it moves");
        Assert.That(world.KineticEnergy + world.PotentialEnergy, Is.EqualTo(start).Within(1e-3 * most));
        Assert.That(world.Joints.Max(joint => joint.Drift.Distance), Is.LessThan(2e-9));
    }

    [TestCase(4)]
    [TestCase(8)]
    public void Step_StarsInLanes_SameBitsAsAlone(int width)
    {
        Assert.That(BitsAfter(width), Is.EqualTo(BitsAfter(1)));
    }

    [Test]
    public void Restore_BetweenSteps_SameBits()
    {
        var world = World.Create(SmallScene.Validate(HubScenes.Star(40)), SolverKind.Exact);
        world.Run(0.1);
        WorldSnapshot half = world.Snapshot();
        world.Run(0.1);
        ulong first = world.StateHash();
        world.Restore(half);
        world.Run(0.1);

        Assert.That(world.StateHash(), Is.EqualTo(first));
    }

    private static (double Numbers, double Operations) Cost(string kind, int joints)
    {
        BlockPattern pattern = IslandOf(HubScenes.Kinds[kind](joints), false, out _).Pattern;
        double operations = pattern.Columns.Sum(column =>
        {
            double below = column.Below.Sum(block => (double)block.Size);
            return column.Size * (below + column.Size) * (below + column.Size);
        });
        return (pattern.Length, operations);
    }

    private static Island IslandOf(SceneDocument document, bool isFrozen, out MultibodySystem mechanism)
    {
        if (isFrozen)
        {
            GameObject hub = document.GameObjects[0];
            var rigid = (Rigidbody)hub.Components[0];
            var frozen = new Rigidbody { Mass = rigid.Mass, InertiaTensor = rigid.InertiaTensor, Constraints = RigidbodyConstraints.FreezeRotationX };
            var turned = new Transform { LocalRotation = Quaterniond.AxisAngle(new Vector3d(1, 2, -2) * (1.0 / 3), 0.7) };
            document = new SceneDocument
            {
                GameObjects = [new GameObject { Id = hub.Id, Name = hub.Name, Transform = turned, Components = [frozen, .. hub.Components.Skip(1)] }, .. document.GameObjects.Skip(1)],
            };
        }

        mechanism = new WorldBuilder(SmallScene.Validate(document), locksAsJoints: true).MultibodySystem;
        return IslandFinder.Find(mechanism).Single();
    }

    private static LaneBatch<ScalarLane> Built(Island island, MultibodySystem mechanism)
    {
        var batch = new LaneBatch<ScalarLane>(island, new Workspace<ScalarLane>(island));
        LaneTransfer<ScalarLane>.GatherConstants(batch, 0, island, mechanism);
        LaneTransfer<ScalarLane>.Gather(batch, mechanism, Dt);
        FreeMotion<ScalarLane>.Stay(batch);
        BilateralRows<ScalarLane>.Evaluate(batch);
        DelassusMatrix<ScalarLane>.InverseInertias(batch);
        BilateralRows<ScalarLane>.Build(batch);
        batch.Work.Active[0] = 1;
        return batch;
    }

    private static void SetMomenta(LaneBatch<ScalarLane> batch, Func<double> next)
    {
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            for (int i = 0; i < 6; i++)
            {
                batch.Bodies[LaneBatch<ScalarLane>.Body(body, BodyLanes.V) + i] = next();
            }
        }
    }

    private static ulong BitsAfter(int width)
    {
        var scenes = new List<GameObject>();
        for (int star = 0; star < 9; star++)
        {
            int first = scenes.Count;
            scenes.AddRange(HubScenes.Star(20).GameObjects.Select((part, i) => new GameObject
            {
                Id = $"star{star}/{part.Id}",
                Name = part.Name,
                Transform = part.Transform,
                Components = part.Components.Select(component => Part(component, first, star)).ToArray(),
            }));
        }

        MultibodySystem mechanism = new WorldBuilder(SmallScene.Validate(new SceneDocument { GameObjects = scenes }), locksAsJoints: true).MultibodySystem;
        Assert.That(IslandFinder.Find(mechanism), Has.Count.EqualTo(9).And.All.Matches<Island>(island => island!.Hubs.Length == 1));
        var solver = new RattleSolver(mechanism, width);
        for (int i = 0; i < 10; i++)
        {
            solver.Step(Dt);
        }

        return MechanismMeasures.Bits(mechanism);
    }

    private static Component Part(Component component, int first, int star) => component switch
    {
        Rigidbody body => new Rigidbody { Mass = body.Mass + 0.1 * star, InertiaTensor = body.InertiaTensor, AngularDamping = 0 },
        HingeJoint hinge => new HingeJoint { ConnectedBody = hinge.ConnectedBody + first, Axis = hinge.Axis, Anchor = hinge.Anchor },
        _ => component,
    };
}
