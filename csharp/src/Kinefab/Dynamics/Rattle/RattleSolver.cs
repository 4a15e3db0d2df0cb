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
    private readonly List<IslandGroup> _groups = new();
    private readonly Dictionary<int, LoopConsistency> _fits = new();
    private readonly List<Island> _alone = new();
    private readonly List<LaneIsland> _inLanes = new();
    private readonly Action<JointReaction[]> _writeReactions;

    // How often islands were found: a number for those that are there.
    private int _findings;
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
    /// <param name="mechanism">Bodies and joints.</param>
    /// <param name="loops">What <see cref="LoopConsistencyProbe"/> found in it.</param>
    /// <param name="maxWidth">Most islands to solve side by side; the result does not depend on it.</param>
    public RattleSolver(MultibodySystem mechanism, List<InconsistentLoop> loops, int maxWidth = int.MaxValue)
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
                _fits[joint] = loop.Consistency;
            }
        }

        Regroup();
    }

    /// <inheritdoc/>
    public void Step(double dt)
    {
        _mechanism.UnreadReactions = null;
        if (IsStale(out bool canBreak))
        {
            Regroup();
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
        // Where the groups are to be made anew by the next step, there is nothing to remember.
        bool isStale = !tape.IsPlaying && IsStale(out _);
        int findings = _findings;
        tape.Value(ref isStale);
        tape.Value(ref findings);
        if (tape.IsPlaying && (isStale || findings != _findings))
        {
            Regroup();
        }
        else if (tape.IsPlaying)
        {
            MakeGroups();
        }

        foreach (IslandGroup group in _groups)
        {
            if (!isStale)
            {
                group.Exchange(tape);
            }
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

    private void Regroup()
    {
        _mechanism.HasChangedBodies = false;
        _findings++;
        _alone.Clear();
        _inLanes.Clear();
        List<Island> rest = IslandFinder.Find(_mechanism);
        _watch = new LayoutWatch(_mechanism.Joints);
        for (int i = 0; i < _mechanism.Joints.Length; i++)
        {
            if (_mechanism.Joints[i].Layout().IsEmpty)
            {
                _mechanism.Reactions[i] = default;
            }
        }

        foreach (Island island in rest)
        {
            // What a break has left of an island that was probed is still as it was found.
            RowBlock? probed = Array.Find(island.Blocks, block => block.Joint != null && _fits.ContainsKey(block.Index));
            island.Loops = probed is null ? LoopConsistency.Exact : _fits[probed.Index];
        }

        foreach (Island island in rest)
        {
            LaneIsland? lanes = LaneIsland.Of(island);
            if (lanes is null)
            {
                _alone.Add(island);
            }
            else
            {
                _inLanes.Add(lanes);
            }
        }

        MakeGroups();
    }

    // With nothing remembered, of the islands that were found: these never change, and their patterns cost more than a step where they are wide.
    private void MakeGroups()
    {
        _groups.Clear();
        foreach (List<Island> some in InGroups(_alone))
        {
            _groups.Add(new ScalarIslandGroup(_mechanism, some));
        }

        var inLanes = new List<LaneIsland>(_inLanes);
        while (inLanes.Count > 0)
        {
            LaneIsland shape = inLanes[0];
            List<LaneIsland> alike = inLanes.FindAll(island => island.HasShapeOf(shape));
            inLanes.RemoveAll(new HashSet<LaneIsland>(alike).Contains);
            AddInLanes(alike);
        }
    }

    private void AddInLanes(List<LaneIsland> islands)
    {
#if NET
        if (_maxWidth >= 8 && islands.Count >= 8 && System.Runtime.Intrinsics.Vector512.IsHardwareAccelerated)
        {
            int whole = islands.Count / 8 * 8;
            AddGroups<Lane8>(islands.GetRange(0, whole));
            islands.RemoveRange(0, whole);
        }

        if (_maxWidth >= 4 && islands.Count >= 2 && System.Runtime.Intrinsics.Vector256.IsHardwareAccelerated)
        {
            AddGroups<Lane4>(islands);
            return;
        }
#endif
        AddGroups<ScalarLane>(islands);
    }

    private void AddGroups<V>(List<LaneIsland> islands)
        where V : struct, ILane<V>
    {
        foreach (List<LaneIsland> some in InGroups(islands))
        {
            _groups.Add(new LaneIslandGroup<V>(_mechanism, some));
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
