using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Articulations;

/// <summary>
/// Gauss-Seidel over all freedoms, one visit of the tree a sweep: outwards each joint's rows are solved with the velocities that the ones before
/// left, on the way back their impulses are handed inwards. Source: DyFeatherstoneArticulation.cpp, solveInternalJointConstraintRecursive.
/// </summary>
internal sealed class JointSweeps
{
    private const int Axes = ArticulationTree.MostAxes;

    private readonly ArticulationTree _tree;
    private readonly ForwardDynamics _dynamics;
    private readonly LinkResponses _responses;
    private readonly ArticulationRules _rules;
    private readonly AxisRows[] _rows;

    // Of each link the motion's change in this sweep, as its children see it, and the impulses from them.
    private readonly SharedTwist[] _changes;
    private readonly SharedWrench[] _impulses;

    // Of each freedom: speed before the sweeps, impulse of this visit.
    private readonly double[] _startSpeeds;
    private readonly double[] _given;

    // Few freedoms: the speeds themselves go through the sweeps, and the impulses and speeds since the last flush are known.
    private readonly JointSpaceResponse? _small;
    private readonly double[] _flushedSpeeds;

    private bool _hasGiven;
    private bool _isSmall;

    /// <summary>Rows of joints to the world; null: none.</summary>
    public ILinkRows? WorldRows;

    public JointSweeps(ArticulationTree tree, ForwardDynamics dynamics, LinkResponses responses, ArticulationRules rules)
    {
        _tree = tree;
        _dynamics = dynamics;
        _responses = responses;
        _rules = rules;
        _rows = new AxisRows[tree.Freedoms];
        _changes = new SharedTwist[tree.Count];
        _impulses = new SharedWrench[tree.Count];
        _startSpeeds = new double[JointSpaceResponse.PaddedCount(tree.Freedoms)];
        _flushedSpeeds = new double[tree.Freedoms];
        _small = tree.Freedoms <= JointSpaceResponse.MostFreedoms ? new JointSpaceResponse(tree, dynamics) : null;
        _given = new double[tree.Freedoms];
    }

    /// <summary>Whether a sweep may do anything: else the responses need not be found.</summary>
    public bool Needed()
    {
        for (int i = 1; i < _tree.Count; i++)
        {
            LinkDefinition link = _tree.Links[i];
            for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
            {
                ref LinkAxis axis = ref link.Axes[_tree.AxisOf[f]];
                if (axis.HasDrive || axis.Motion == LinkMotion.Limited || link.Friction > 0 || Math.Abs(_tree.Speeds[f]) > link.MaxJointSpeed)
                    return true;
            }
        }

        return false;
    }

    /// <summary>Rows of the step, and the responses that they need.</summary>
    /// <param name="dt">s.</param>
    /// <param name="hasJoints">Whether rows of others act on the links.</param>
    /// <param name="transmitted">Of each link what its joint carries, for friction.</param>
    public void Prepare(double dt, bool hasJoints, ReadOnlySpan<Wrench> transmitted)
    {
        _isSmall = _small != null && !hasJoints;
        if (_isSmall)
            _small!.Find();
        if (!_isSmall || _rules.ComplianceShare > 0)
            _responses.FindResponses();
        for (int i = 1; i < _tree.Count; i++)
        {
            int first = _tree.FirstFreedom[i];
            int count = _tree.FirstFreedom[i + 1] - first;
            LinkDefinition link = _tree.Links[i];
            double compliance = _rules.Compliance;
            if (_rules.ComplianceShare > 0)
                compliance += _rules.ComplianceShare * Math.Max(_responses.Links[i].LargestLinear, _responses.Links[_tree.Parents[i]].LargestLinear);
            double maxFriction = link.Friction > 0 ? Length(transmitted[i]) * link.Friction * dt : 0;
            for (int k = 0; k < count; k++)
            {
                int f = first + k;
                ref AxisRows row = ref _rows[f];
                row.Response = _isSmall ? _small!.Own(f) : _responses.AxisSpeeds[f * Axes + k];
                row.InverseResponse = row.Response > 0 ? 1 / (row.Response + compliance) : 0;
                row.MaxFriction = maxFriction;
                row.MaxSpeed = link.MaxJointSpeed;
                ref LinkAxis axis = ref _tree.AxisOfFreedom(i, f);
                double gap = axis.HasDrive && count > 1 && _rules.DrivesSphericalByRotation ? RotationGap(i, _tree.AxisOf[f]) : axis.Target - _tree.Positions[f];
                row.Prepare(axis, gap, _tree.Positions[f], dt, _rules);
            }
        }
    }

    /// <summary>Adds what the sweeps gave to the links' motions and the joints' speeds.</summary>
    public void Flush()
    {
        if (!_isSmall)
        {
            _responses.Flush(_tree.Motions, _tree.Speeds, _startSpeeds);
            return;
        }

        for (int f = 0; f < _flushedSpeeds.Length; f++)
        {
            double change = _startSpeeds[f] - _flushedSpeeds[f];
            _flushedSpeeds[f] = change;
            _tree.Speeds[f] += change;
        }

        _small!.Move(_flushedSpeeds, _given, _tree.Motions);
        Mark();
    }

    /// <summary>Speeds from which the sweeps start, as the links' motions have them after their prediction.</summary>
    public void Start()
    {
        for (int i = 1; i < _tree.Count; i++)
        {
            Twist relative = _tree.Motions[i] - _tree.Motions[_tree.Parents[i]].At(_dynamics.Levers[i]);
            for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
                _startSpeeds[f] = _tree.Links[i].Joint == LinkJointKind.Prismatic ? Vector3d.Dot(_dynamics.Axis[f].Linear, relative.Linear) : Vector3d.Dot(_dynamics.Axis[f].Angular, relative.Angular);
        }

        if (_isSmall)
            Mark();
    }

    /// <summary>One sweep; false when no row gave anything, so that another would not either.</summary>
    public bool Sweep(bool isVelocityIteration, double dt)
    {
        _hasGiven = false;
        if (_isSmall)
            return SweepSmall(isVelocityIteration, dt);
        _changes[0] = _responses.RootChange;
        _impulses[0] = default;
        SolveWorldRows(0);
        int at = 0;
        for (int i = 1; i < _tree.Count; i++)
        {
            int parent = _tree.Parents[i];
            for (; at != parent; at = _tree.Parents[at])
                Leave(at);
            Enter(i, parent, isVelocityIteration, dt);
            at = i;
        }

        for (; at > 0; at = _tree.Parents[at])
            Leave(at);
        _responses.RootKept += _impulses[0];
        return _hasGiven;
    }

    private bool SweepSmall(bool isVelocityIteration, double dt)
    {
        bool hasGiven = false;
        for (int f = 0; f < _given.Length; f++)
        {
            double given = _rows[f].Solve(_startSpeeds[f], isVelocityIteration, dt, _rules);
            if (given == 0)
                continue;
            hasGiven = true;
            _given[f] += given;
            _small!.Add(f, given, _startSpeeds);
        }

        return hasGiven;
    }

    private void Mark()
    {
        Array.Copy(_startSpeeds, _flushedSpeeds, _flushedSpeeds.Length);
        Array.Clear(_given, 0, _given.Length);
    }

    /// <summary>Impulse of a freedom's drive and friction in the step, N s or N m s.</summary>
    public double MotorImpulse(int freedom) => _rows[freedom].MotorImpulse;

    private void Enter(int link, int parent, bool isVelocityIteration, double dt)
    {
        _impulses[link] = default;
        int first = _tree.FirstFreedom[link];
        int end = _tree.FirstFreedom[link + 1];
        if (end - first == 1)
            EnterOne(link, parent, first, isVelocityIteration, dt);
        else
            EnterSeveral(link, parent, first, end, isVelocityIteration, dt);
        SolveWorldRows(link);
    }

    // Nearly all joints: as EnterSeveral, without its loops.
    private void EnterOne(int link, int parent, int freedom, bool isVelocityIteration, double dt)
    {
        ref SharedTwist above = ref _changes[parent];
        double answer = _dynamics.InverseInertias[link * Axes * Axes] * _responses.Kept[freedom] - SharedTwist.Dot(_responses.Reactions[freedom], above);
        double given = _rows[freedom].Solve(_startSpeeds[freedom] + answer, isVelocityIteration, dt, _rules);
        _given[freedom] = given;
        _hasGiven |= given != 0;
        _changes[link] = above + _responses.Axis[freedom] * answer + _responses.AxisChanges[freedom] * given;
    }

    private void EnterSeveral(int link, int parent, int first, int end, bool isVelocityIteration, double dt)
    {
        SharedTwist change = _changes[parent];
        Span<double> speeds = stackalloc double[Axes];
        for (int f = first; f < end; f++)
        {
            speeds[f - first] = _responses.Speed(link, f, _changes[parent]);
            change += _responses.Axis[f] * speeds[f - first];
        }

        for (int f = first; f < end; f++)
        {
            double given = _rows[f].Solve(_startSpeeds[f] + speeds[f - first], isVelocityIteration, dt, _rules);
            _given[f] = given;
            if (given == 0)
                continue;
            _hasGiven = true;
            change += _responses.AxisChanges[f] * given;
            for (int k = f + 1; k < end; k++)
                speeds[k - first] += _responses.AxisSpeeds[f * Axes + k - first] * given;
        }

        _changes[link] = change;
    }

    private void SolveWorldRows(int link)
    {
        if (WorldRows == null || !WorldRows.Has(link))
            return;
        Twist change = _changes[link].At(_responses.Arms[link]);
        Wrench impulse = default;
        if (!WorldRows.Solve(link, ref change, ref impulse))
            return;
        _hasGiven = true;
        _changes[link] = new SharedTwist(change, _responses.Arms[link]);
        _impulses[link] += new SharedWrench(impulse, _responses.Arms[link]);
    }

    private void Leave(int link)
    {
        SharedWrench impulse = _impulses[link];
        SharedWrench passed = impulse;
        for (int f = _tree.FirstFreedom[link]; f < _tree.FirstFreedom[link + 1]; f++)
        {
            double onFreedom = _given[f] + SharedTwist.Dot(impulse, _responses.Axis[f]);
            _responses.Kept[f] += onFreedom;
            passed -= _responses.Reactions[f] * onFreedom;
        }

        int parent = _tree.Parents[link];
        _impulses[parent] += passed;
        if (link != _tree.LastChildren[parent])
            _changes[parent] += new SharedTwist(_responses.Links[parent].Times(passed.At(_responses.Arms[parent])), _responses.Arms[parent]);
    }

    // Twice the vector part of what is left of the turn to the targets' rotation vector.
    private double RotationGap(int link, int axis)
    {
        Vector3d target = Vector3d.Zero;
        for (int f = _tree.FirstFreedom[link]; f < _tree.FirstFreedom[link + 1]; f++)
        {
            ref LinkAxis other = ref _tree.AxisOfFreedom(link, f);
            int a = _tree.AxisOf[f];
            if (other.HasDrive)
                target += new Vector3d(a == 0 ? other.Target : 0, a == 1 ? other.Target : 0, a == 2 ? other.Target : 0);
        }

        Quaterniond goal = TreeKinematics.Turn(target);
        Quaterniond now = TreeKinematics.RelativeRotation(_tree, link);
        Quaterniond left = goal.Conjugate() * now;
        return (left.W < 0 ? 2 : -2) * left.Vector[axis];
    }

    // As PhysX adds them up: N and N m.
    private static double Length(in Wrench w) => w.Force.Length + w.Torque.Length;
}

/// <summary>Rows of joints that hold one link to the world: PhysX solves them on the way through the tree, right after the link's own.</summary>
internal interface ILinkRows
{
    /// <summary>Whether a link has any.</summary>
    bool Has(int link);

    /// <summary>Solves them once.</summary>
    /// <param name="link">Which.</param>
    /// <param name="change">Change of its motion in the sweeps since the last flush; takes what the rows add.</param>
    /// <param name="impulse">Impulses on it in this visit; takes what the rows add.</param>
    /// <returns>Whether any gave something.</returns>
    bool Solve(int link, ref Twist change, ref Wrench impulse);
}
