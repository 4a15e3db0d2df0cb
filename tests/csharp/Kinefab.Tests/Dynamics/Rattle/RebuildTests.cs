using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>
/// The exact solver finds its islands anew when a joint gets other rows or a body another mass: that can be ended early, as the rest of a step, takes
/// over the patterns that stay the same, and is part of no state that is come back to.
/// </summary>
public sealed class RebuildTests
{
    private const double Dt = 0.01;
    private static readonly CancellationToken Cancelled = new(true);

    // It went on to its end, a second on a grid of 8,000 joints, and was cancelled after that.
    [Test]
    public void Step_CancelledThatHasToRebuild_EndsBeforeItIsDone([Values("star", "grid")] string kind)
    {
        MultibodySystem mechanism = System(HubScenes.Kinds[kind](100));
        MultibodySystem twin = System(HubScenes.Kinds[kind](100));
        var solver = new RattleSolver(mechanism);
        var other = new RattleSolver(twin);
        solver.Step(Dt);
        other.Step(Dt);
        mechanism.HasChangedBodies = true;
        twin.HasChangedBodies = true;
        var before = new StateTape();
        mechanism.Exchange(before);
        solver.Exchange(before);

        mechanism.Cancellation = Cancelled;
        Assert.That(() => solver.Step(Dt), Throws.InstanceOf<OperationCanceledException>());
        Assert.That(mechanism.HasChangedBodies, Is.True, "what was found anew is not in use");

        mechanism.Cancellation = default;
        before.Play();
        mechanism.Exchange(before);
        solver.Exchange(before);
        for (int i = 0; i < 3; i++)
        {
            solver.Step(Dt);
            other.Step(Dt);
        }

        Assert.That(MechanismMeasures.Bits(mechanism), Is.EqualTo(MechanismMeasures.Bits(twin)));
    }

    // The patterns of an island's forms, which is what takes long, were found to their end.
    [Test]
    public void Groups_Cancelled_AreNotMade()
    {
        MultibodySystem mechanism = System(HubScenes.Grid(5));
        mechanism.Cancellation = Cancelled;
        Assert.That(() => new ScalarIslandGroup(mechanism, new List<Island> { IslandOf(mechanism) }), Throws.InstanceOf<OperationCanceledException>());
        Assert.That(() => new LaneIslandGroup<ScalarLane>(mechanism, new List<LaneIsland> { LaneIsland.Of(IslandOf(mechanism))! }), Throws.InstanceOf<OperationCanceledException>());
        Assert.That(() => new RattleSolver(mechanism, new List<InconsistentLoop>()), Throws.InstanceOf<OperationCanceledException>());
    }

    [Test]
    public void Step_CancelledAfterADrive_LeavesTheWorldAsItWas([Values("star", "pair", "comb", "grid")] string kind, [Values] bool isUndone)
    {
        ValidScene scene = SmallScene.Validate(HubScenes.Kinds[kind](60));
        World plain = World.Create(scene, SolverKind.Exact);
        World cancelled = World.Create(scene, SolverKind.Exact);
        for (int step = 0; step < 12; step++)
        {
            Drive(plain, step);
            Drive(cancelled, step);
            (ulong, double) before = (cancelled.StateHash(), cancelled.Time);
            for (int attempt = 0; attempt < 3; attempt++)
            {
                // Where it is cut off is another place each time; what is asserted holds for all of them.
                using var source = new CancellationTokenSource();
                WorldSnapshot whole = cancelled.Snapshot();
                source.CancelAfter(TimeSpan.FromTicks(3_000L * attempt * (step + 1)));
                try
                {
                    cancelled.Step(Dt, source.Token);
                    cancelled.Restore(whole);
                }
                catch (OperationCanceledException)
                {
                    Assert.That((cancelled.StateHash(), cancelled.Time), Is.EqualTo(before));
                }
            }

            if (isUndone)
            {
                Undo(plain, step);
                Undo(cancelled, step);
            }

            plain.Step(Dt);
            cancelled.Step(Dt);
            Assert.That(cancelled.StateHash(), Is.EqualTo(plain.StateHash()), $"step {step}");
            Assert.That((cancelled.Stops, cancelled.Findings.Diagnostics.Count), Is.EqualTo((plain.Stops, plain.Findings.Diagnostics.Count)));
        }
    }

    // What the solver remembered was gone, since a drive that was taken back had made it out of date when the state was taken down.
    [Test]
    public void Restore_OfADriveThatIsTakenBack_SameBits([Values("star", "comb", "grid")] string kind)
    {
        ValidScene scene = SmallScene.Validate(HubScenes.Kinds[kind](60));
        World plain = World.Create(scene, SolverKind.Exact);
        World restored = World.Create(scene, SolverKind.Exact);
        foreach (World world in new[] { plain, restored })
        {
            world.Run(0.1, step: Dt);
            Drive(world, 0);
        }

        WorldSnapshot driven = restored.Snapshot();
        restored.Step(Dt);
        restored.Restore(driven);
        foreach (World world in new[] { plain, restored })
        {
            Undo(world, 0);
            world.Run(0.1, step: Dt);
        }

        Assert.That(restored.StateHash(), Is.EqualTo(plain.StateHash()));
    }

    [Test]
    public void Patterns_OfIslandsAsTheyWere_AreNotFoundTwice()
    {
        MultibodySystem mechanism = System(HubScenes.Grid(5));
        var known = new KnownPatterns();
        Island first = IslandOf(mechanism);
        Island unordered = IslandOf(mechanism);
        known.Add(unordered);
        first.Order(default);
        known.Add(first);

        Island same = IslandOf(mechanism);
        known.GiveTo(same);
        Assert.That(same.Pattern, Is.SameAs(first.Pattern));

        // With one row more it is another; in lanes that is a row about the hinge's axis, in the same place.
        var hinge = (RevoluteJoint)mechanism.Joints[7];
        hinge.MotorEnabled = true;
        hinge.MotorForceLimit = 1;
        Island driven = IslandOf(mechanism);
        known.GiveTo(driven);
        Assert.That(driven.IsOrdered, Is.False);
        LaneIsland lanes = LaneIsland.Of(driven)!;
        Assert.That(lanes.InLanes, Is.Not.SameAs(driven));
        Assert.That(lanes.InLanes.Pattern, Is.SameAs(driven.Pattern));
    }

    // The islands are found anew, and are as they were.
    [Test]
    public void Step_AfterARebuildOfWhatHasNotChanged_HasTheBitsOfNone()
    {
        MultibodySystem kept = System(HubScenes.Grid(5));
        MultibodySystem rebuilt = System(HubScenes.Grid(5));
        List<Island> probed = IslandFinder.Find(rebuilt);
        List<InconsistentLoop> loops = LoopConsistencyProbe.Find(rebuilt, probed, default);
        Assert.That(probed.Single().IsOrdered, Is.True);
        var solver = new RattleSolver(kept, loops);
        var other = new RattleSolver(rebuilt, loops, probed: probed);
        for (int i = 0; i < 5; i++)
        {
            rebuilt.HasChangedBodies = true;
            solver.Step(Dt);
            other.Step(Dt);
            Assert.That(MechanismMeasures.Bits(rebuilt), Is.EqualTo(MechanismMeasures.Bits(kept)));
        }
    }

    // Another joint each time, so that the solver is rebuilt each time.
    private static void Drive(World world, int step) => world.Joints[step + 1].DriveAt(Coordinate.Angle, 1 + step);

    private static void Undo(World world, int step)
    {
        var hinge = (WorldHingeJoint)world.Joints[step + 1];
        hinge.Settings = hinge.Settings with { UseMotor = false };
    }

    private static MultibodySystem System(SceneDocument document) => new WorldBuilder(SmallScene.Validate(document), locksAsJoints: true).MultibodySystem;

    private static Island IslandOf(MultibodySystem mechanism) => IslandFinder.Find(mechanism).Single();
}
