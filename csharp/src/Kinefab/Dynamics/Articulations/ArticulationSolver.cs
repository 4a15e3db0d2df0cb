using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Articulations;

/// <summary>
/// One articulation as PhysX steps it: free motion by the articulated-body algorithm, then sweeps of the joints' rows, semi-implicit. The caller
/// runs the iterations, since joints and other bodies take part in them. Source: DyFeatherstoneForwardDynamic.cpp (computeUnconstrainedVelocities,
/// updateBodies, propagateLinksDown), DySolverCore.cpp (solveNoContactsCase).
/// </summary>
internal sealed class ArticulationSolver
{
    private readonly ArticulationRules _rules;
    private readonly ForwardDynamics _dynamics;
    private readonly JointSweeps _sweeps;

    private readonly Wrench[] _external;
    private readonly Wrench[] _internal;
    private readonly CarriedWrenches _carried;
    private readonly Twist[] _scratch;
    private readonly Twist[] _accelerations;
    private readonly double[] _noForces;

    // As the step began and ended, for what the joints carried in it.
    private readonly Pose[] _startPoses;
    private readonly Twist[] _startMotions;
    private readonly Twist[] _endMotions;
    private readonly double[] _jointForces;

    // Of the position iterations: they move the links.
    private readonly double[] _movingSpeeds;
    private readonly Twist[] _movingMotions;

    private double _dt;
    private bool _needsFlush;
    private bool _hasFriction;

    public ArticulationSolver(ArticulationTree tree, ArticulationRules rules)
    {
        Tree = tree;
        _rules = rules;
        _dynamics = new ForwardDynamics(tree);
        Responses = new LinkResponses(tree, _dynamics);
        _sweeps = new JointSweeps(tree, _dynamics, Responses, rules);
        int n = tree.Count;
        Applied = new Wrench[n];
        _external = new Wrench[n];
        _internal = new Wrench[n];
        _carried = new CarriedWrenches(tree);
        _scratch = new Twist[n];
        _accelerations = new Twist[n];
        _noForces = new double[tree.Freedoms];
        _startPoses = new Pose[n];
        _startMotions = new Twist[n];
        _endMotions = new Twist[n];
        _jointForces = new double[tree.Freedoms];
        _movingSpeeds = new double[tree.Freedoms];
        _movingMotions = new Twist[n];
    }

    public ArticulationTree Tree { get; }

    /// <summary>What joints on its links use.</summary>
    public LinkResponses Responses { get; }

    /// <summary>Forces on the links over the next step, at their centres of mass; cleared by it.</summary>
    public Wrench[] Applied { get; }

    /// <summary>What joints between its links and the world ask for; null: there are none.</summary>
    public ILinkRows? WorldRows
    {
        get => _sweeps.WorldRows;
        set => _sweeps.WorldRows = value;
    }

    /// <summary>Added to the response of a joint's row on a link: 5 only.</summary>
    public double JointCompliance(int link) => _rules.ComplianceShare * Responses.Links[link].LargestLinear;

    /// <summary>A whole step without anything else.</summary>
    public void Step(Vector3d gravity, double dt, int positionIterations, int velocityIterations)
    {
        Begin(gravity, dt, hasJoints: false);
        for (int i = 0; i < positionIterations && Sweep(isVelocityIteration: false); i++)
        {
        }

        EndPositionIterations();
        for (int i = 0; i < velocityIterations && Sweep(isVelocityIteration: true); i++)
        {
        }

        Finish();
    }

    /// <summary>Velocities after forces, gravity, damping and the joints' own accelerations; then the rows.</summary>
    public void Begin(Vector3d gravity, double dt, bool hasJoints)
    {
        _dt = dt;
        _dynamics.SpeedLimitStep = _rules.ScalesSpeedsTogether ? 0 : dt;
        LimitSpeeds();
        if (Tree.IsFixed)
            Tree.Motions[0] = default;
        _dynamics.Update();
        Tree.Poses.CopyTo(_startPoses, 0);
        Tree.Motions.CopyTo(_startMotions, 0);
        Tree.Forces.CopyTo(_jointForces, 0);
        FindForces(gravity);
        _dynamics.FindInertias();
        if (Tree.IsFixed || !_rules.KeepsMomentum)
        {
            for (int i = 0; i < Tree.Count; i++)
                _external[i] += _internal[i];
            Accelerate(_external, Tree.Forces, withSpeedTerms: true);
        }
        else
        {
            Array.Clear(_accelerations, 0, _accelerations.Length);
            Accelerate(_external, _noForces, withSpeedTerms: false);
            MomentumBalance before = MomentumBalance.Of(Tree);
            Accelerate(_internal, Tree.Forces, withSpeedTerms: true);
            MomentumBalance.Restore(Tree, before);
            for (int i = 0; i < Tree.Count; i++)
                _external[i] += _internal[i];
        }

        Array.Clear(Tree.Forces, 0, Tree.Forces.Length);
        Array.Clear(Applied, 0, Applied.Length);
        _needsFlush = hasJoints || _sweeps.Needed();
        _hasFriction = false;
        foreach (LinkDefinition link in Tree.Links)
            _hasFriction |= link.Friction > 0;
        if (!_needsFlush)
            return;
        _sweeps.Prepare(dt, hasJoints, _hasFriction ? _carried.Find(_startPoses, _dynamics.Levers, _accelerations, _external) : default);
        _sweeps.Start();
    }

    /// <summary>The joints' own rows once; false when another sweep would do nothing.</summary>
    public bool Sweep(bool isVelocityIteration) => _needsFlush && _sweeps.Sweep(isVelocityIteration, _dt);

    /// <summary>Change of a link's motion since the last flush, by rows.</summary>
    public Twist Motion(int link) => Tree.Motions[link] + Responses.Change(link);

    /// <summary>The velocities so far are those that move the links.</summary>
    public void EndPositionIterations()
    {
        Flush();
        Tree.Speeds.CopyTo(_movingSpeeds, 0);
        Tree.Motions.CopyTo(_movingMotions, 0);
    }

    /// <summary>Moves the links.</summary>
    public void Finish()
    {
        Flush();
        Tree.Motions.CopyTo(_endMotions, 0);
        bool keepsMomentum = !Tree.IsFixed && _rules.KeepsMomentum;
        MomentumBalance before = keepsMomentum ? MomentumBalance.Of(Tree) : default;
        Vector3d moved = Vector3d.Zero;
        if (keepsMomentum)
        {
            for (int i = 0; i < Tree.Count; i++)
                moved += _movingMotions[i].Linear * Tree.Links[i].Mass;
        }

        if (!Tree.IsFixed)
            Tree.Poses[0] = Integrate(Tree.Poses[0], _movingMotions[0]);
        for (int i = 1; i < Tree.Count; i++)
            Advance(i);
        if (keepsMomentum)
            KeepMomentum(before, moved * (_dt / before.Mass));
    }

    /// <summary>
    /// What each link's joint did to it in the last step on average, but for drives, friction and forces on the freedoms: the constraint of its
    /// locked axes and limits. World axes, N and N m, about the joint's anchor in the link; that of the root has no meaning.
    /// </summary>
    /// <param name="impulses">What other joints and couplings did to the links, about their centres of mass, N s and N m s.</param>
    /// <param name="reactions">Takes them.</param>
    public void Reactions(ReadOnlySpan<Wrench> impulses, Span<Wrench> reactions)
    {
        double rate = 1 / _dt;
        for (int i = 0; i < Tree.Count; i++)
        {
            _scratch[i] = (_endMotions[i] - _startMotions[i]) * rate;
            reactions[i] = _external[i] + impulses[i] * rate;
        }

        ReadOnlySpan<Wrench> carried = _carried.Find(_startPoses, _dynamics.Levers, _scratch, reactions);
        for (int i = 1; i < Tree.Count; i++)
        {
            bool slides = Tree.Links[i].Joint == LinkJointKind.Prismatic;
            Wrench reaction = carried[i].From(_startPoses[i].Rotation * -Tree.Links[i].Anchor.Position);
            for (int f = Tree.FirstFreedom[i]; f < Tree.FirstFreedom[i + 1]; f++)
            {
                double motor = _jointForces[f] + (_needsFlush ? _sweeps.MotorImpulse(f) * rate : 0);
                reaction -= slides ? new Wrench(_dynamics.Axis[f].Linear * motor, Vector3d.Zero) : new Wrench(Vector3d.Zero, _dynamics.Axis[f].Angular * motor);
            }

            reactions[i] = reaction;
        }
    }

    private void LimitSpeeds()
    {
        double ratio = 1;
        for (int i = 1; i < Tree.Count; i++)
        {
            double most = Tree.Links[i].MaxJointSpeed;
            for (int f = Tree.FirstFreedom[i]; f < Tree.FirstFreedom[i + 1]; f++)
            {
                double speed = Tree.Speeds[f];
                if (!_rules.ScalesSpeedsTogether)
                    Tree.Speeds[f] = Math.Min(Math.Max(speed, -most), most);
                else if (Math.Abs(speed) > most)
                    ratio = Math.Min(ratio, most / Math.Abs(speed));
            }
        }

        for (int f = 0; ratio < 1 && f < Tree.Speeds.Length; f++)
            Tree.Speeds[f] *= ratio;
    }

    // Damping acts on the velocity that the forces will give, too: F (1 - d dt) - m v d. What turns faster than its body may is held back by the
    // torque that would slow it down to that by itself, with nothing hung on it (4.1: computeD).
    private void FindForces(Vector3d gravity)
    {
        double most = 1 / _dt;
        for (int i = 0; i < Tree.Count; i++)
        {
            LinkDefinition link = Tree.Links[i];
            Twist motion = Tree.Motions[i];
            Quaterniond q = Tree.Poses[i].Rotation;
            double linear = Math.Min(link.LinearDamping, most);
            double angular = Math.Min(link.AngularDamping, most);
            Vector3d weight = link.UseGravity ? gravity * link.Mass : Vector3d.Zero;
            Vector3d own = q.InverseRotate(motion.Angular);
            Vector3d spin = q * Vector3d.Scale(link.Inertia, own);
            double speed = own.Length;
            double excess = speed > link.MaxAngularSpeed ? (1 - link.MaxAngularSpeed / speed) * most : 0;
            _external[i] = new Wrench(
                (weight + Applied[i].Force) * (1 - linear * _dt) - motion.Linear * (link.Mass * linear),
                Applied[i].Torque * (1 - angular * _dt) - spin * (angular + excess));
            _internal[i] = new Wrench(Vector3d.Zero, -Vector3d.Cross(motion.Angular, spin));
        }
    }

    private void Accelerate(Wrench[] forces, double[] jointForces, bool withSpeedTerms)
    {
        _dynamics.Accelerate(forces, jointForces, withSpeedTerms);
        bool addsUp = !Tree.IsFixed && _rules.KeepsMomentum;
        for (int i = 0; i < Tree.Count; i++)
        {
            Twist acceleration = _dynamics.Accelerations[i];
            Tree.Motions[i] += acceleration * _dt;
            _accelerations[i] = addsUp ? _accelerations[i] + acceleration : acceleration;
        }

        for (int f = 0; f < Tree.Freedoms; f++)
            Tree.Speeds[f] += _dynamics.JointAccelerations[f] * _dt;
    }

    private void Flush()
    {
        if (_needsFlush)
            _sweeps.Flush();
    }

    private Pose Integrate(in Pose pose, in Twist motion) =>
        new(pose.Position + motion.Linear * _dt, (TreeKinematics.Turn(motion.Angular * _dt) * pose.Rotation).Normalized());

    private void Advance(int link)
    {
        int first = Tree.FirstFreedom[link];
        if (Tree.Links[link].Joint == LinkJointKind.Spherical)
        {
            Quaterniond turned = (TreeKinematics.Turn(_movingMotions[link].Angular * _dt) * Tree.Poses[link].Rotation).Normalized();
            Tree.Poses[link] = new Pose(Tree.Poses[link].Position, turned);
            Pose relative = new(Vector3d.Zero, TreeKinematics.RelativeRotation(Tree, link));
            TreeKinematics.ReadSpherical(Tree, link);
            Tree.Poses[link] = TreeKinematics.Place(Tree, link, relative);
            return;
        }

        if (Tree.FirstFreedom[link + 1] > first)
        {
            double position = Tree.Positions[first] + _movingSpeeds[first] * _dt;
            ref LinkAxis axis = ref Tree.Links[link].Axes[0];
            if (Tree.Links[link].Joint == LinkJointKind.Prismatic && axis.Motion == LinkMotion.Limited)
                position = Math.Min(Math.Max(position, axis.Lower), axis.Upper);
            Tree.Positions[first] = position;
        }

        Tree.Poses[link] = TreeKinematics.Place(Tree, link, TreeKinematics.Relative(Tree, link));
    }

    private void KeepMomentum(in MomentumBalance before, Vector3d way)
    {
        TreeKinematics.Move(Tree);
        MomentumBalance.Restore(Tree, before);
        Vector3d missing = before.Center + way - MomentumBalance.Of(Tree).Center;
        for (int i = 0; i < Tree.Count; i++)
            Tree.Poses[i] = new Pose(Tree.Poses[i].Position + missing, Tree.Poses[i].Rotation);
    }
}
