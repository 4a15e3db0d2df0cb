using System;
using System.Collections.Generic;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Which bodies hang together: by couplings and by unbroken joints that have rows; fixed bodies join nothing.</summary>
internal static class IslandFinder
{
    /// <summary>The islands of a mechanism's unbroken joints, by the lowest index of their bodies.</summary>
    public static List<Island> Find(MultibodySystem mechanism)
    {
        JointModel[] joints = mechanism.Joints;
        Bodies bodies = mechanism.Bodies;
        var sets = new DisjointSets(bodies.Count);
        foreach (JointModel joint in joints)
        {
            if (Holds(joint))
            {
                Unite(joint.Body0, joint.Body1);
            }
        }

        foreach (CoordinateCoupling coupling in mechanism.Couplings)
        {
            for (int i = 0; coupling.IsWhole && i < coupling.Coordinates.Length; i++)
            {
                JointModel joint = coupling.Coordinates[i].Joint;
                Unite(joint.Body0, joint.Body1);
                Unite(AnyMovingOf(coupling), AnyMoving(joint));
            }
        }

        var members = new SortedDictionary<int, Builder>();
        for (int i = 0; i < bodies.Count; i++)
        {
            if (Moves(i))
            {
                int root = sets.Find(i);
                if (!members.TryGetValue(root, out Builder? builder))
                {
                    members.Add(root, builder = new Builder(bodies));
                }

                builder.AddMoving(i);
            }
        }

        for (int j = 0; j < joints.Length; j++)
        {
            int body = AnyMoving(joints[j]);
            if (body >= 0 && Holds(joints[j]))
            {
                members[sets.Find(body)].Add(joints[j], j);
            }
        }

        for (int c = 0; c < mechanism.Couplings.Length; c++)
        {
            CoordinateCoupling coupling = mechanism.Couplings[c];
            int body = AnyMovingOf(coupling);
            if (body >= 0 && coupling.IsWhole)
            {
                members[sets.Find(body)].Add(coupling, c);
            }
        }

        var islands = new List<Island>();
        foreach (Builder builder in members.Values)
        {
            islands.Add(builder.Build());
        }

        return islands;

        bool Moves(int body) => body >= 0 && !bodies.IsKinematic[body];

        int AnyMoving(JointModel joint) => Moves(joint.Body0) ? joint.Body0 : Moves(joint.Body1) ? joint.Body1 : -1;

        int AnyMovingOf(CoordinateCoupling coupling)
        {
            int body = -1;
            foreach (CoordinateAxisMap coordinate in coupling.Coordinates)
            {
                body = Math.Max(body, AnyMoving(coordinate.Joint));
            }

            return body;
        }

        void Unite(int a, int b)
        {
            if (Moves(a) && Moves(b))
            {
                sets.Join(a, b);
            }
        }
    }

    /// <summary>Each of an island's <see cref="JointLoops"/> as an island of its own, without couplings.</summary>
    public static List<Island> FindLoops(Island island, MultibodySystem mechanism)
    {
        var loops = new List<Island>();
        foreach (int[] blocks in JointLoops.Of(island))
        {
            var builder = new Builder(mechanism.Bodies);
            var moving = new SortedSet<int>();
            foreach (int n in blocks)
            {
                moving.UnionWith(island.Blocks[n].Bodies);
            }

            foreach (int body in moving)
            {
                if (body < island.MovingBodies)
                {
                    builder.AddMoving(island.Bodies[body]);
                }
            }

            foreach (int n in blocks)
            {
                builder.Add(island.Blocks[n].Joint!, island.Blocks[n].Index);
            }

            loops.Add(builder.Build());
        }

        return loops;
    }

    private static bool Holds(JointModel joint) => !joint.IsBroken && !joint.Layout().IsEmpty;

    private sealed class Builder
    {
        private readonly Bodies _bodies;
        private readonly List<int> _moving = new();
        private readonly List<int> _fixed = new();
        private readonly List<(JointModel? Joint, CoordinateCoupling? Coupling, int Index)> _items = new();
        private readonly Dictionary<int, int> _slots = new();

        public Builder(Bodies bodies) => _bodies = bodies;

        public void AddMoving(int body)
        {
            _slots.Add(body, _moving.Count);
            _moving.Add(body);
        }

        public void Add(JointModel joint, int index) => _items.Add((joint, null, index));

        public void Add(CoordinateCoupling coupling, int index) => _items.Add((null, coupling, index));

        public Island Build()
        {
            var blocks = new RowBlock[_items.Count];
            for (int i = 0; i < blocks.Length; i++)
            {
                (JointModel? joint, CoordinateCoupling? coupling, int index) = _items[i];
                blocks[i] = joint != null
                    ? new RowBlock(joint, index, new[] { Slot(joint.Body0), Slot(joint.Body1) })
                    : MakeNode(coupling!, index);
            }

            _moving.AddRange(_fixed);
            return new Island(_moving.ToArray(), _moving.Count - _fixed.Count, blocks, _bodies);
        }

        private RowBlock MakeNode(CoordinateCoupling coupling, int index)
        {
            var bodies = new List<int>();
            var sides = new int[2 * coupling.Coordinates.Length];
            for (int i = 0; i < sides.Length; i++)
            {
                JointModel joint = coupling.Coordinates[i / 2].Joint;
                int slot = Slot(i % 2 == 0 ? joint.Body0 : joint.Body1);
                sides[i] = bodies.IndexOf(slot);
                if (sides[i] < 0)
                {
                    sides[i] = bodies.Count;
                    bodies.Add(slot);
                }
            }

            return new RowBlock(coupling, index, bodies.ToArray(), sides);
        }

        private int Slot(int body)
        {
            if (!_slots.TryGetValue(body, out int slot))
            {
                slot = _moving.Count + _fixed.Count;
                _slots.Add(body, slot);
                _fixed.Add(body);
            }

            return slot;
        }
    }
}
