using System;
using System.Collections.Generic;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Order in which PGS sweeps the joints. PhysX colours them greedily: a joint between two moving bodies takes the first
/// partition that neither body is in; a joint to the world or to a kinematic body comes after all partitions of its moving
/// body. Within a partition no two joints share a body, so only the partitions decide the result. The joint made last
/// is coloured first: seen in PhysX's traces, for every graph tried.
/// Source: DyConstraintPartition.cpp, classifyConstraintDesc and writeConstraintDesc.
/// What no moving body connects does not see each other's sweeps: such islands come one after the other, some together in a part, so that
/// all sweeps of a part find its rows in the processor's cache, and parts may be swept by several threads.
/// </summary>
internal sealed class SolveOrder
{
    // Joints of one body beyond this many are swept last, in order.
    private const int MaxPartitions = 64;

    // Joints and bodies with which a part is full.
    private const int FullPart = 128;

    private readonly MultibodySystem _mechanism;
    private readonly Predicate<int> _isElsewhere;
    private readonly Predicate<int> _isLink;
    private readonly ulong[] _used;
    private readonly int[] _last;
    private readonly int[] _partition;
    private readonly int[] _order;
    private int _count;
    private int[] _firstJoints = Array.Empty<int>();
    private int[][] _bodies = Array.Empty<int[]>();

    /// <param name="mechanism">Whose joints.</param>
    /// <param name="isElsewhere">Joints that others solve.</param>
    /// <param name="isLink">Bodies that others move.</param>
    /// <param name="isOnePart">Whether islands are not to be told apart: others connect them.</param>
    public SolveOrder(MultibodySystem mechanism, Predicate<int> isElsewhere, Predicate<int> isLink, bool isOnePart)
    {
        _mechanism = mechanism;
        _isElsewhere = isElsewhere;
        _isLink = isLink;
        IsOnePart = isOnePart;
        _used = new ulong[mechanism.Bodies.Count];
        _last = new int[mechanism.Bodies.Count];
        _partition = new int[mechanism.Joints.Length];
        _order = new int[mechanism.Joints.Length];
        Refresh();
    }

    /// <summary>Indices of the joints that are whole, in the order of their sweep.</summary>
    public ReadOnlySpan<int> Joints => _order.AsSpan(0, _count);

    /// <summary>Whether islands are not told apart.</summary>
    public bool IsOnePart { get; }

    /// <summary>At least one.</summary>
    public int PartCount => _bodies.Length;

    /// <summary>Index in <see cref="Joints"/> of a part's first joint; of the part after the last, their number.</summary>
    public int FirstJoint(int part) => _firstJoints[part];

    /// <summary>The moving bodies of a part, links not among them.</summary>
    public int[] Bodies(int part) => _bodies[part];

    /// <summary>Colours again, after a joint broke.</summary>
    public void Refresh()
    {
        Array.Clear(_used, 0, _used.Length);
        Array.Clear(_last, 0, _last.Length);
        int partitions = 0;
        for (int i = _partition.Length - 1; i >= 0; i--)
        {
            JointModel joint = _mechanism.Joints[i];
            if (IsHere(i) && Moves(joint.Body0) && Moves(joint.Body1))
            {
                _partition[i] = FreePartition(joint.Body0, joint.Body1);
                partitions = Math.Max(partitions, _partition[i] + 1);
            }
        }

        for (int i = _partition.Length - 1; i >= 0; i--)
        {
            JointModel joint = _mechanism.Joints[i];
            if (IsHere(i) && Moves(joint.Body0) != Moves(joint.Body1))
            {
                int body = Moves(joint.Body0) ? joint.Body0 : joint.Body1;
                _partition[i] = _last[body]++;
                partitions = Math.Max(partitions, _partition[i] + 1);
            }
        }

        // By partitions, in each by number: a star to the ground has as many partitions as joints.
        var next = new int[partitions + 1];
        for (int i = 0; i < _partition.Length; i++)
        {
            if (IsSwept(i))
            {
                next[_partition[i] + 1]++;
            }
        }

        for (int p = 0; p < partitions; p++)
        {
            next[p + 1] += next[p];
        }

        _count = next[partitions];
        for (int i = 0; i < _partition.Length; i++)
        {
            if (IsSwept(i))
            {
                _order[next[_partition[i]]++] = i;
            }
        }

        MakeParts();
    }

    private bool IsSwept(int i) => IsHere(i) && (Moves(_mechanism.Joints[i].Body0) || Moves(_mechanism.Joints[i].Body1));

    private void MakeParts()
    {
        int[] parts = AssignBodies();
        int count = 1;
        foreach (int part in parts)
        {
            count = Math.Max(count, part + 1);
        }

        var joints = new List<int>[count];
        var bodies = new List<int>[count];
        for (int p = 0; p < count; p++)
        {
            joints[p] = new List<int>();
            bodies[p] = new List<int>();
        }

        for (int i = 0; i < _count; i++)
        {
            JointModel joint = _mechanism.Joints[_order[i]];
            joints[parts[Moves(joint.Body0) ? joint.Body0 : joint.Body1]].Add(_order[i]);
        }

        for (int body = 0; body < parts.Length; body++)
        {
            if (Moves(body) && !_isLink(body))
            {
                bodies[parts[body]].Add(body);
            }
        }

        _firstJoints = new int[count + 1];
        for (int p = 0; p < count; p++)
        {
            joints[p].CopyTo(_order, _firstJoints[p]);
            _firstJoints[p + 1] = _firstJoints[p] + joints[p].Count;
        }

        _bodies = Array.ConvertAll(bodies, list => list.ToArray());
    }

    // The part of each body, that of its island.
    private int[] AssignBodies()
    {
        var parts = new int[_mechanism.Bodies.Count];
        if (IsOnePart)
        {
            return parts;
        }

        var islands = new DisjointSets(parts.Length);
        var sizes = new int[parts.Length];
        for (int i = 0; i < _count; i++)
        {
            JointModel joint = _mechanism.Joints[_order[i]];
            if (Moves(joint.Body0) && Moves(joint.Body1))
            {
                islands.Join(joint.Body0, joint.Body1);
            }
        }

        for (int i = 0; i < _count; i++)
        {
            JointModel joint = _mechanism.Joints[_order[i]];
            sizes[islands.Find(Moves(joint.Body0) ? joint.Body0 : joint.Body1)]++;
        }

        for (int body = 0; body < parts.Length; body++)
        {
            sizes[islands.Find(body)] += Moves(body) ? 1 : 0;
        }

        // The least body stands for its island, and comes first.
        int last = 0;
        int filled = 0;
        for (int body = 0; body < parts.Length; body++)
        {
            int island = islands.Find(body);
            if (island == body)
            {
                if (filled > 0 && filled + sizes[body] > FullPart)
                {
                    last++;
                    filled = 0;
                }

                parts[body] = last;
                filled += sizes[body];
            }

            parts[body] = parts[island];
        }

        return parts;
    }

    private bool IsHere(int joint) => !_mechanism.Joints[joint].IsBroken && !_isElsewhere(joint);

    private int FreePartition(int body0, int body1)
    {
        ulong used = _used[body0] | _used[body1];
        int partition = 0;
        while (partition < MaxPartitions && (used & (1UL << partition)) != 0)
        {
            partition++;
        }

        if (partition < MaxPartitions)
        {
            _used[body0] |= 1UL << partition;
            _used[body1] |= 1UL << partition;
        }

        _last[body0] = Math.Max(_last[body0], partition + 1);
        _last[body1] = Math.Max(_last[body1], partition + 1);
        return partition;
    }

    private bool Moves(int body) => body >= 0 && !_mechanism.Bodies.IsKinematic[body];
}
