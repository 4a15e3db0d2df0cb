using Kinefab.Joints;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Bodies that joints hold together and that a projecting joint touches. The order of a group's bodies, by which its trees
/// are planted, comes of the order in which its joints were united: those that project first, then their neighbours.
/// Source: ScConstraintProjectionManager.cpp, processPendingUpdates and groupUnion.
/// </summary>
internal sealed class ProjectionGroups
{
    private const int None = -1;

    private readonly MultibodySystem _mechanism;
    private readonly BodyJoints _bodyJoints;
    private readonly int[] _parents;
    private readonly int[] _depths;
    private readonly int[] _next;
    private readonly int[] _tails;
    private readonly int[] _queue;

    public ProjectionGroups(MultibodySystem mechanism, BodyJoints bodyJoints)
    {
        _mechanism = mechanism;
        _bodyJoints = bodyJoints;
        int bodies = mechanism.Bodies.Count;
        _parents = new int[bodies];
        _depths = new int[bodies];
        _next = new int[bodies];
        _tails = new int[bodies];

        // A body is asked for its joints once.
        _queue = new int[3 * mechanism.Joints.Length];
    }

    /// <summary>Unites bodies anew.</summary>
    public void Refresh()
    {
        for (int i = 0; i < _parents.Length; i++)
        {
            _parents[i] = None;
            _depths[i] = 0;
            _next[i] = None;
            _tails[i] = i;
        }

        int end = 0;
        for (int i = 0; i < _mechanism.Joints.Length; i++)
        {
            if (Projects(i))
            {
                _queue[end++] = i;
            }
        }

        int projecting = end;
        for (int i = 0; i < end; i++)
        {
            int joint = _queue[i];
            int waits = i < projecting ? joint + 1 : _mechanism.Joints.Length;
            Enqueue(_mechanism.Joints[joint].Body0, joint, waits, ref end);
            Enqueue(_mechanism.Joints[joint].Body1, joint, waits, ref end);
            Unite(_mechanism.Joints[joint]);
        }
    }

    /// <summary>First body of the group that a body is in; -1 for one in none.</summary>
    public int First(int body)
    {
        if (_parents[body] == None)
        {
            return None;
        }

        while (_parents[body] != body)
        {
            body = _parents[body];
        }

        return body;
    }

    /// <summary>The body after this one in its group; -1 after the last.</summary>
    public int Next(int body) => _next[body];

    private bool Projects(int joint) => _mechanism.Joints[joint].Projection && !_mechanism.Joints[joint].IsBroken;

    // The other joints of a body not met before; projecting ones from `waits` on are in the queue already.
    private void Enqueue(int body, int joint, int waits, ref int end)
    {
        if (body < 0 || _parents[body] != None)
        {
            return;
        }

        foreach (int i in _bodyJoints.Of(body))
        {
            if (i != joint && !_mechanism.Joints[i].IsBroken && !(i >= waits && Projects(i)))
            {
                _queue[end++] = i;
            }
        }
    }

    private void Unite(JointModel joint)
    {
        int any = joint.Body0 < 0 ? joint.Body1 : joint.Body0;
        int other = joint.Body0 < 0 ? JointModel.World : joint.Body1;
        int first = Root(any);
        if (other < 0)
        {
            return;
        }

        int second = Root(other);
        if (first == second)
        {
            return;
        }

        if (_depths[first] <= _depths[second])
        {
            (first, second) = (second, first);
            _depths[first]++;
        }

        _parents[second] = first;
        _next[_tails[first]] = second;
        _tails[first] = _tails[second];
    }

    private int Root(int body)
    {
        if (_parents[body] == None)
        {
            _parents[body] = body;
        }

        return First(body);
    }
}
