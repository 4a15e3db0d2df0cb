using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Which joints project which body, and in which order: trees that grow, layer by layer, from bodies held by the world, or
/// else from the body with the most joints. A joint outside the trees (one that closes a loop) does not project.
/// Source: ScConstraintProjectionTree.cpp; ScConstraintSim.cpp, projectPose.
/// </summary>
internal sealed class ProjectionOrder
{
    // Ranks of the bodies as roots: held with projection, held at all, and one for every joint to a moving body.
    private const long HeldByProjection = 1L << 31;
    private const long HeldByWorld = 1L << 30;
    private const long HeldByKinematic = 1L << 29;

    private readonly MultibodySystem _mechanism;
    private readonly BodyJoints _bodyJoints;
    private readonly ProjectionGroups _groups;
    private readonly RankOrder _rankOrder;
    private readonly long[] _ranks;
    private readonly int[] _anchors;
    private readonly bool[] _isPlanted;
    private readonly bool[] _found;
    private readonly int[] _roots;
    private readonly int[] _queue;
    private readonly int[] _joints;
    private readonly bool[] _movesBody1;
    private int _count;

    public ProjectionOrder(MultibodySystem mechanism)
    {
        _mechanism = mechanism;
        int bodies = mechanism.Bodies.Count;
        _bodyJoints = new BodyJoints(mechanism);
        _groups = new ProjectionGroups(mechanism, _bodyJoints);
        _ranks = new long[bodies];
        _rankOrder = new RankOrder(_ranks);
        _anchors = new int[bodies];
        _isPlanted = new bool[bodies];
        _found = new bool[bodies];
        _roots = new int[bodies];
        _queue = new int[bodies];
        _joints = new int[bodies];
        _movesBody1 = new bool[bodies];
        Refresh();
    }

    /// <summary>Plants the trees again, after a joint broke: Unity then destroys it.</summary>
    public void Refresh()
    {
        _count = 0;
        if (!Array.Exists(_mechanism.Joints, j => j.Projection && !j.IsBroken))
        {
            return;
        }

        _groups.Refresh();
        for (int i = 0; i < _found.Length; i++)
        {
            _ranks[i] = 0;
            _anchors[i] = -1;
            _found[i] = _mechanism.Bodies.IsKinematic[i];
            _isPlanted[i] = false;
        }

        for (int i = 0; i < _mechanism.Joints.Length; i++)
        {
            JointModel joint = _mechanism.Joints[i];
            if (!joint.IsBroken)
            {
                Rank(i, joint, joint.Body0, joint.Body1);
                Rank(i, joint, joint.Body1, joint.Body0);
            }
        }

        foreach (JointModel joint in _mechanism.Joints)
        {
            int first = joint.Projection && !joint.IsBroken ? _groups.First(joint.Body0 < 0 ? joint.Body1 : joint.Body0) : -1;
            if (first >= 0 && !_isPlanted[first])
            {
                _isPlanted[first] = true;
                Plant(first);
            }
        }
    }

    /// <summary>Projects the bodies' poses; a joint that broke in this step no longer does. Motions that a body is denied, it is denied here too.</summary>
    public void Apply()
    {
        Bodies bodies = _mechanism.Bodies;
        for (int i = 0; i < _count; i++)
        {
            JointModel joint = _mechanism.Joints[_joints[i]];
            Pose pose0 = bodies.PoseOf(joint.Body0);
            Pose pose1 = bodies.PoseOf(joint.Body1);
            if (!joint.IsBroken && Projections.Apply(joint, ref pose0, ref pose1, _movesBody1[i]))
            {
                int moved = _movesBody1[i] ? joint.Body1 : joint.Body0;
                bodies.Poses[moved] = BodyMotion.Unlocked(bodies.Poses[moved], _movesBody1[i] ? pose1 : pose0, bodies.Locks[moved]);
            }
        }
    }

    private void Rank(int index, JointModel joint, int body, int other)
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

    // Every body held with projection is a root; their trees grow together. Then what they do not reach, tree by tree.
    private void Plant(int first)
    {
        int count = 0;
        for (int body = first; body >= 0; body = _groups.Next(body))
        {
            if (Moves(body))
            {
                _roots[count++] = body;
                _found[body] = _ranks[body] >= HeldByProjection;
            }
        }

        _rankOrder.Sort(_roots.AsSpan(0, count));
        int end = 0;
        while (end < count && _ranks[_roots[end]] >= HeldByProjection)
        {
            Add(_anchors[_roots[end]], _roots[end]);
            _queue[end] = _roots[end];
            end++;
        }

        int held = end;
        Grow(end);
        for (int i = held; i < count; i++)
        {
            if (!_found[_roots[i]])
            {
                _found[_roots[i]] = true;
                _queue[0] = _roots[i];
                Grow(1);
            }
        }
    }

    private void Grow(int end)
    {
        for (int next = 0; next < end; next++)
        {
            int parent = _queue[next];
            foreach (int i in _bodyJoints.Of(parent))
            {
                JointModel joint = _mechanism.Joints[i];
                int child = joint.Body0 == parent ? joint.Body1 : joint.Body1 == parent ? joint.Body0 : JointModel.World;
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
