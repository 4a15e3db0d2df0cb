using System;
using Kinefab.Joints;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Order in which PGS sweeps the joints. PhysX colours them greedily: a joint between two moving bodies takes the first
/// partition that neither body is in; a joint to the world or to a kinematic body comes after all partitions of its moving
/// body. Within a partition no two joints share a body, so only the partitions decide the result. The joint made last
/// is coloured first: seen in PhysX's traces, for every graph tried.
/// Source: DyConstraintPartition.cpp, classifyConstraintDesc and writeConstraintDesc.
/// </summary>
internal sealed class SolveOrder
{
    // Joints of one body beyond this many are swept last, in order.
    private const int MaxPartitions = 64;

    private readonly MultibodySystem _mechanism;
    private readonly Predicate<int> _isElsewhere;
    private readonly ulong[] _used;
    private readonly int[] _last;
    private readonly int[] _partition;
    private readonly int[] _order;
    private int _count;

    /// <param name="mechanism">Whose joints.</param>
    /// <param name="isElsewhere">Joints that others solve.</param>
    public SolveOrder(MultibodySystem mechanism, Predicate<int> isElsewhere)
    {
        _mechanism = mechanism;
        _isElsewhere = isElsewhere;
        _used = new ulong[mechanism.Bodies.Count];
        _last = new int[mechanism.Bodies.Count];
        _partition = new int[mechanism.Joints.Length];
        _order = new int[mechanism.Joints.Length];
        Refresh();
    }

    /// <summary>Indices of the joints that are whole, in the order of their sweep.</summary>
    public ReadOnlySpan<int> Joints => _order.AsSpan(0, _count);

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

        _count = 0;
        for (int p = 0; p < partitions; p++)
        {
            for (int i = 0; i < _partition.Length; i++)
            {
                JointModel joint = _mechanism.Joints[i];
                if (_partition[i] == p && IsHere(i) && (Moves(joint.Body0) || Moves(joint.Body1)))
                {
                    _order[_count++] = i;
                }
            }
        }
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
