using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Which joints project which body, and in which order: trees that grow, layer by layer, from bodies held by the world, or
/// else from the body with the most joints. A joint outside the trees (one that closes a loop) does not project.
/// Source: ScConstraintProjectionTree.cpp.
/// </summary>
internal sealed class ProjectionOrder
{
    // Ranks of the bodies as roots: held with projection, held at all, and one for every joint to a moving body.
    private const long HeldByProjection = 1L << 31;
    private const long HeldByWorld = 1L << 30;
    private const long HeldByKinematic = 1L << 29;

    private readonly MultibodySystem _mechanism;
    private readonly long[] _ranks;
    private readonly int[] _anchors;
    private readonly bool[] _found;
    private readonly int[] _queue;
    private readonly int[] _joints;
    private readonly bool[] _movesBody1;
    private int _count;

    public ProjectionOrder(MultibodySystem mechanism)
    {
        _mechanism = mechanism;
        int bodies = mechanism.Bodies.Count;
        _ranks = new long[bodies];
        _anchors = new int[bodies];
        _found = new bool[bodies];
        _queue = new int[bodies];
        _joints = new int[bodies];
        _movesBody1 = new bool[bodies];
        Refresh();
    }

    /// <summary>Plants the trees again, after a joint broke.</summary>
    public void Refresh()
    {
        _count = 0;
        if (!Array.Exists(_mechanism.Joints, j => j.Projection && !j.IsBroken))
        {
            return;
        }

        Array.Clear(_ranks, 0, _ranks.Length);
        for (int i = 0; i < _found.Length; i++)
        {
            _anchors[i] = -1;
            _found[i] = _mechanism.Bodies.IsKinematic[i];
        }

        for (int i = 0; i < _mechanism.Joints.Length; i++)
        {
            Joint joint = _mechanism.Joints[i];
            if (!joint.IsBroken)
            {
                Rank(i, joint, joint.Body0, joint.Body1);
                Rank(i, joint, joint.Body1, joint.Body0);
            }
        }

        // Every body held with projection is a root; their trees grow together.
        int end = 0;
        for (int i = 0; i < _ranks.Length; i++)
        {
            if (!_found[i] && _ranks[i] >= HeldByProjection)
            {
                _found[i] = true;
                Add(_anchors[i], i);
                _queue[end++] = i;
            }
        }

        Grow(end);
        for (int root = NextRoot(); root >= 0; root = NextRoot())
        {
            _found[root] = true;
            _queue[0] = root;
            Grow(1);
        }
    }

    /// <summary>Projects the bodies' poses.</summary>
    public void Apply()
    {
        Bodies bodies = _mechanism.Bodies;
        for (int i = 0; i < _count; i++)
        {
            Joint joint = _mechanism.Joints[_joints[i]];
            Pose pose0 = bodies.PoseOf(joint.Body0);
            Pose pose1 = bodies.PoseOf(joint.Body1);
            if (!joint.Project(ref pose0, ref pose1, _movesBody1[i]))
            {
                continue;
            }

            if (_movesBody1[i])
            {
                bodies.Poses[joint.Body1] = pose1;
            }
            else
            {
                bodies.Poses[joint.Body0] = pose0;
            }
        }
    }

    private void Rank(int index, Joint joint, int body, int other)
    {
        if (!Moves(body))
        {
            return;
        }

        if (Moves(other))
        {
            _ranks[body]++;
            return;
        }

        long rank = (joint.Projection ? HeldByProjection : 0) | (other < 0 ? HeldByWorld : HeldByKinematic);
        if (_anchors[body] < 0 || rank > _ranks[body])
        {
            _anchors[body] = index;
        }

        _ranks[body] |= rank;
    }

    private int NextRoot()
    {
        int best = -1;
        for (int i = 0; i < _ranks.Length; i++)
        {
            if (!_found[i] && _ranks[i] > 0 && (best < 0 || _ranks[i] > _ranks[best]))
            {
                best = i;
            }
        }

        return best;
    }

    private void Grow(int end)
    {
        for (int next = 0; next < end; next++)
        {
            int parent = _queue[next];
            for (int i = 0; i < _mechanism.Joints.Length; i++)
            {
                Joint joint = _mechanism.Joints[i];
                int child = joint.Body0 == parent ? joint.Body1 : joint.Body1 == parent ? joint.Body0 : Joint.World;
                if (!joint.IsBroken && Moves(child) && !_found[child])
                {
                    _found[child] = true;
                    Add(i, child);
                    _queue[end++] = child;
                }
            }
        }
    }

    private void Add(int joint, int moved)
    {
        if (_mechanism.Joints[joint].Projection)
        {
            _joints[_count] = joint;
            _movesBody1[_count] = _mechanism.Joints[joint].Body1 == moved;
            _count++;
        }
    }

    private bool Moves(int body) => body >= 0 && !_mechanism.Bodies.IsKinematic[body];
}
