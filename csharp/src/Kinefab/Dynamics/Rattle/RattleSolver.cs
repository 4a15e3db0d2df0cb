using System;
using System.Collections.Generic;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Solves each island of a mechanism directly: maximal coordinates, one block-sparse factorisation a step, closed to
/// the tolerance at position level, so that the mechanism's true motion is known.
/// </summary>
internal sealed class RattleSolver : ISolver, IStepParts
{
    // Largest gap, metres or radians, that a step may leave: at 1/60 s the first, in shorter steps by the square of the step
    // less, so that what a gap leaves in the speeds, gap / h, does not outweigh the method's own error, which falls with
    // h^2; never less than rounding lets it reach.
    private const double MostGap = 1e-9;
    private const double LeastGap = 2e-13;
    private const double GapAcceleration = 3.6e-6;

    // Islands of a group at most: what one thread takes at a time. Each group has room of its own to step an island alone.
    private const int MostInGroup = 24;

    private readonly MultibodySystem _mechanism;
    private readonly int _maxWidth;
    private readonly Dictionary<int, LoopConsistency> _consistencies = new();
    private readonly Action<JointReaction[]> _writeReactions;
    private List<IslandGroup> _groups = new();

    // The islands as they were found last. Others come in their place, but these lists never change, so that a state that is taken down keeps them.
    private List<Island> _alone = new();
    private List<LaneIsland> _inLanes = new();
    private LayoutWatch _watch;
    private double _dt;
    private double _tolerance;
    private bool _areReactionsAwaited;

    /// <summary>A solver for the mechanism as it stands.</summary>
    /// <param name="mechanism">Bodies and joints.</param>
    /// <param name="maxWidth">Most islands to solve side by side; the result does not depend on it.</param>
    public RattleSolver(MultibodySystem mechanism, int maxWidth = int.MaxValue)
        : this(mechanism, LoopConsistencyProbe.Find(mechanism), maxWidth)
    {
    }

    /// <summary>A solver for the mechanism as it stands.</summary>
    /// <param name="mechanism">Bodies and joints; its <see cref="MultibodySystem.Cancellation"/> ends the making early.</param>
    /// <param name="loops">What <see cref="LoopConsistencyProbe"/> found in it.</param>
    /// <param name="maxWidth">Most islands to solve side by side; the result does not depend on it.</param>
    /// <param name="probed">The islands that it looked at, for the patterns that they have; null: none.</param>
    public RattleSolver(MultibodySystem mechanism, List<InconsistentLoop> loops, int maxWidth = int.MaxValue, List<Island>? probed = null)
    {
        _mechanism = mechanism;
        _maxWidth = maxWidth;
        _writeReactions = WriteReactions;
        foreach (JointModel joint in mechanism.Joints)
        {
            joint.LimitsFromAfar = true;
            joint.FinishTwist(mechanism.Bodies.PoseOf(joint.Body0), mechanism.Bodies.PoseOf(joint.Body1));
        }

        foreach (InconsistentLoop loop in loops)
        {
            foreach (int joint in loop.Joints)
            {
                _consistencies[joint] = loop.Consistency;
            }
        }

        var known = new KnownPatterns();
        probed?.ForEach(known.Add);
        Regroup(known);
    }

    /// <inheritdoc/>
    public void Step(double dt)
    {
        _mechanism.UnreadReactions = null;
        if (IsStale(out bool canBreak))
        {
            Regroup(Known());
            _watch.IsStale(out canBreak);
        }

        _mechanism.Unsolved.Clear();
        _mechanism.Closed.Clear();
        _mechanism.ForbiddenSpeeds.Clear();
        _mechanism.HeldLimits.Clear();
        _mechanism.StalledJoints.Clear();
        _dt = dt;
        _areReactionsAwaited = canBreak;
        _tolerance = Math.Min(MostGap, Math.Max(LeastGap, GapAcceleration * dt * dt));
        StepThreads.ForEach(this, _groups.Count, _mechanism.Threads);
        foreach (IslandGroup group in _groups)
        {
            group.Report(_mechanism);
        }

        _mechanism.UnreadReactions = canBreak ? null : _writeReactions;

        Bodies bodies = _mechanism.Bodies;
        for (int i = 0; i < bodies.Count; i++)
        {
            if (bodies.IsKinematic[i])
            {
                bodies.Poses[i] = bodies.KinematicTargets[i];
            }
        }

        Array.Clear(bodies.Forces, 0, bodies.Count);
        Array.Clear(bodies.Torques, 0, bodies.Count);
    }

    /// <inheritdoc/>
    void IStepParts.Do(int part)
    {
        _mechanism.Cancellation.ThrowIfCancellationRequested();
        _groups[part].Step(_dt, _tolerance, _areReactionsAwaited);
    }

    /// <inheritdoc/>
    public void Exchange(StateTape tape)
    {
        // Also where they are out of date by now, since a joint may become again what it was before anything is found anew.
        tape.Value(ref _alone);
        tape.Value(ref _inLanes);
        tape.Value(ref _watch);
        if (tape.IsPlaying)
        {
            _groups = MakeGroups(_alone, _inLanes);
        }

        foreach (IslandGroup group in _groups)
        {
            group.Exchange(tape);
        }
    }

    private bool IsStale(out bool canBreak) => _watch.IsStale(out canBreak) | _mechanism.HasChangedBodies;

    private void WriteReactions(JointReaction[] reactions)
    {
        foreach (IslandGroup group in _groups)
        {
            group.WriteReactions(reactions);
        }
    }

    // What a break or a bridge between islands has made of loops that were probed is as bad as the worst of them, while it has loops.
    private LoopConsistency Consistency(Island island)
    {
        LoopConsistency worst = LoopConsistency.Exact;
        foreach (RowBlock block in island.Blocks)
        {
            bool isProbed = _consistencies.TryGetValue(block.Index, out LoopConsistency consistency) && block.Joint != null && island.HasJointLoops;
            worst = isProbed && consistency > worst ? consistency : worst;
        }

        return worst;
    }

    // What is found takes its place at the end and in whole, lest one that is ended early leave half of it.
    private void Regroup(KnownPatterns known)
    {
        var alone = new List<Island>();
        var inLanes = new List<LaneIsland>();
        foreach (Island island in IslandFinder.Find(_mechanism))
        {
            _mechanism.Cancellation.ThrowIfCancellationRequested();

            island.Loops = Consistency(island);
            LaneIsland? lanes = LaneIsland.Of(island);
            if (lanes is null)
            {
                known.GiveTo(island);
                alone.Add(island);
            }
            else
            {
                foreach (Island form in lanes.Forms)
                {
                    known.GiveTo(form);
                }

                inLanes.Add(lanes);
            }
        }

        List<IslandGroup> groups = MakeGroups(alone, inLanes);
        CarryOver(_groups, groups);
        _groups = groups;
        _alone = alone;
        _inLanes = inLanes;
        _watch = new LayoutWatch(_mechanism.Joints);
        _mechanism.HasChangedBodies = false;
        for (int i = 0; i < _mechanism.Joints.Length; i++)
        {
            if (_mechanism.Joints[i].Layout().IsEmpty)
            {
                _mechanism.Reactions[i] = default;
            }
        }
    }

    // Islands that are as they were go on as if nothing had been found anew. What the last step of another only showed of stiff springs' answers stays: a
    // joint that broke took with it the spring that would give them in the next step.
    private static void CarryOver(List<IslandGroup> from, List<IslandGroup> to)
    {
        var known = new Dictionary<int, (IslandGroup Group, int Island)>();
        foreach (IslandGroup group in from)
        {
            for (int i = 0; i < group.Islands.Length; i++)
            {
                known.Add(group.Islands[i].Bodies[0], (group, i));
            }
        }

        foreach (IslandGroup group in to)
        {
            for (int i = 0; i < group.Islands.Length; i++)
            {
                int body = group.Islands[i].Bodies[0];
                if (known.TryGetValue(body, out (IslandGroup Group, int Island) old) && group.Islands[i].IsSameAs(old.Group.Islands[old.Island]))
                {
                    var tape = new StateTape();
                    old.Group.Exchange(tape, old.Island);
                    tape.Play();
                    group.Exchange(tape, i);
                }
            }
        }
    }

    // Of the islands that there are.
    private KnownPatterns Known()
    {
        var known = new KnownPatterns();
        _alone.ForEach(known.Add);
        foreach (LaneIsland island in _inLanes)
        {
            foreach (Island form in island.Forms)
            {
                known.Add(form);
            }
        }

        return known;
    }

    // With nothing remembered, of the islands that were found: these never change, and their patterns cost more than a step where they are wide.
    private List<IslandGroup> MakeGroups(List<Island> alone, List<LaneIsland> inLanes)
    {
        var groups = new List<IslandGroup>();
        foreach (List<Island> some in InGroups(alone))
        {
            groups.Add(new ScalarIslandGroup(_mechanism, some));
        }

        var rest = new List<LaneIsland>(inLanes);
        while (rest.Count > 0)
        {
            LaneIsland shape = rest[0];
            List<LaneIsland> alike = rest.FindAll(island => island.HasShapeOf(shape));
            rest.RemoveAll(new HashSet<LaneIsland>(alike).Contains);
            AddInLanes(groups, alike);
        }

        return groups;
    }

    private void AddInLanes(List<IslandGroup> groups, List<LaneIsland> islands)
    {
#if NET
        if (_maxWidth >= 8 && islands.Count >= 8 && System.Runtime.Intrinsics.Vector512.IsHardwareAccelerated)
        {
            int whole = islands.Count / 8 * 8;
            AddGroups<Lane8>(groups, islands.GetRange(0, whole));
            islands.RemoveRange(0, whole);
        }

        if (_maxWidth >= 4 && islands.Count >= 2 && System.Runtime.Intrinsics.Vector256.IsHardwareAccelerated)
        {
            AddGroups<Lane4>(groups, islands);
            return;
        }
#endif
        AddGroups<ScalarLane>(groups, islands);
    }

    private void AddGroups<V>(List<IslandGroup> groups, List<LaneIsland> islands)
        where V : struct, ILane<V>
    {
        foreach (List<LaneIsland> some in InGroups(islands))
        {
            groups.Add(new LaneIslandGroup<V>(_mechanism, some));
        }
    }

    private static IEnumerable<List<T>> InGroups<T>(List<T> islands)
    {
        for (int first = 0; first < islands.Count; first += MostInGroup)
        {
            yield return islands.GetRange(first, Math.Min(MostInGroup, islands.Count - first));
        }
    }
}
