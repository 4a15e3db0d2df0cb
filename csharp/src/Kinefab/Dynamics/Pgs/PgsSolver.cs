using System;
using Kinefab.Dynamics.Articulations;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Projected Gauss-Seidel as PhysX 4.1 does it and so Unity: position iterations with the error as bias, whose
/// velocity moves the bodies; then velocity iterations without it, whose velocity is kept. No warm start. Its drift, softness and loss of energy
/// are PhysX's own. Of both iterations there are as many as the moving body that asks for most, as PhysX has it among up to 128 bodies.
/// Source: DySolverControl.cpp, DyConstraintSetup.cpp, DySolverConstraints.cpp (solve1D), DyBodyCoreIntegrator.h.
/// </summary>
internal sealed class PgsSolver : ISolver
{
    private readonly MultibodySystem _mechanism;
    private readonly Bodies _bodies;
    private readonly SolveOrder _order;
    private readonly ProjectionOrder _projection;
    private readonly CouplingRows _couplings;
    private readonly ArticulatedBodies _articulated;
    private readonly LinkRows _linkRows;
    private readonly Action<JointReaction[]> _writeReactions;
    private Action<JointReaction[]>? _unread;
    private double _dt;

    // One more than there are bodies: the last stands for the world and never moves.
    private readonly Pose[] _startPoses;
    private readonly Vector3d[] _startLinear;
    private readonly Vector3d[] _startAngular;
    private readonly BodyDelta[] _deltas;
    private readonly BodyDelta[] _motions;
    private readonly Vector3d[] _rootInertia;
    private readonly SqrtInertia[] _sqrtInertia;

    private readonly JointBlock[] _blocks;
    private readonly SweepRows _rows;
    private readonly ReactionSums _reactions;

    // One joint's rows on their way into the sweeps.
    private readonly ConstraintRow[] _given = new ConstraintRow[JointModel.MaxRows];
    private readonly int[] _sorted = new int[JointModel.MaxRows];
    private readonly double[] _responses = new double[JointModel.MaxRows];
    private readonly double[] _least = new double[JointModel.MaxRows];

    public PgsSolver(MultibodySystem mechanism)
        : this(mechanism, ArticulatedBodies.None(mechanism))
    {
    }

    /// <summary>With articulations among the bodies.</summary>
    public PgsSolver(MultibodySystem mechanism, ArticulatedBodies articulated)
    {
        _mechanism = mechanism;
        _bodies = mechanism.Bodies;
        _articulated = articulated;
        _linkRows = new LinkRows(mechanism, articulated);
        _writeReactions = WriteReactions;
        _order = new SolveOrder(mechanism, _linkRows.Takes);
        _projection = new ProjectionOrder(mechanism);
        _couplings = new CouplingRows(mechanism, _linkRows.TakesCoupling);
        int slots = _bodies.Count + 1;
        _startPoses = new Pose[slots];
        _startPoses[_bodies.Count] = Pose.Identity;
        _startLinear = new Vector3d[slots];
        _startAngular = new Vector3d[slots];

        // And one more, which takes the changes of what cannot move.
        _deltas = new BodyDelta[slots + 1];
        _motions = new BodyDelta[slots + 1];
        _rootInertia = Array.ConvertAll(_bodies.InverseInertias, SqrtInertia.Root);
        _sqrtInertia = new SqrtInertia[slots];
        _blocks = new JointBlock[mechanism.Joints.Length];
        _rows = new SweepRows(mechanism.Joints.Length);
        _reactions = new ReactionSums(mechanism, _blocks, _rows, _startPoses);
    }

    /// <inheritdoc/>
    public void Step(double dt)
    {
        if (_mechanism.HasChangedBodies)
        {
            _mechanism.HasChangedBodies = false;
            for (int i = 0; i < _bodies.Count; i++)
                _rootInertia[i] = SqrtInertia.Root(_bodies.InverseInertias[i]);
        }

        _dt = dt;
        int positionIterations = 0;
        int velocityIterations = 0;
        for (int i = 0; i < _bodies.Count; i++)
        {
            if (!_articulated.IsLink(i))
                BodyMotion.PredictVelocity(_bodies, i, _mechanism.Gravity, dt);
            _sqrtInertia[i] = SqrtInertia.At(_bodies.Poses[i].Rotation, _rootInertia[i]);
            _startPoses[i] = _bodies.Poses[i];
            _startLinear[i] = _bodies.LinearVelocities[i];
            _startAngular[i] = _bodies.AngularVelocities[i];
            if (!_bodies.IsKinematic[i] || _articulated.IsLink(i))
            {
                positionIterations = Math.Max(positionIterations, _bodies.PositionIterations[i]);
                velocityIterations = Math.Max(velocityIterations, _bodies.VelocityIterations[i]);
            }
        }

        int blocks = Prepare(dt);
        _couplings.Prepare(_sqrtInertia, dt);
        _articulated.Begin(dt, _linkRows.IsNeeded);
        _linkRows.Prepare(dt);
        Array.Clear(_deltas, 0, _deltas.Length);
        _rows.Constants = _rows.BiasedConstants;
        for (int i = 0; i < positionIterations; i++)
        {
            Sweep(blocks);
            _couplings.Sweep(_deltas);
            SweepArticulations(isVelocityIteration: false);
        }

        foreach (ArticulationSolver articulation in _articulated.Solvers)
            articulation.EndPositionIterations();
        _linkRows.RemoveBias();
        Array.Copy(_deltas, _motions, _deltas.Length);
        _rows.Constants = _rows.UnbiasedConstants;
        _couplings.RemoveBias();
        for (int i = 0; i < velocityIterations; i++)
        {
            Sweep(blocks);
            _couplings.Sweep(_deltas);
            SweepArticulations(isVelocityIteration: true);
        }

        bool broken = _reactions.Break(blocks, dt) | _linkRows.Break(dt);
        if (_articulated.Solvers.Length > 0)
        {
            _unread = _mechanism.UnreadReactions;
            _mechanism.UnreadReactions = _writeReactions;
        }

        for (int i = 0; i < _bodies.Count; i++)
        {
            if (!_articulated.IsLink(i))
                Move(i, dt);
        }

        _articulated.Finish();

        _projection.Apply();
        if (broken)
        {
            _order.Refresh();
            _projection.Refresh();
        }

        _couplings.Finish(dt);
    }

    /// <inheritdoc/>
    public void Exchange(StateTape tape)
    {
        _articulated.Exchange(tape);
        // Nothing is kept from step to step but what follows from the joints.
        if (!tape.IsPlaying)
            return;
        _mechanism.HasChangedBodies = true;
        _order.Refresh();
        _projection.Refresh();
    }

    private void SweepArticulations(bool isVelocityIteration)
    {
        _linkRows.Sweep(_deltas, _sqrtInertia);
        foreach (ArticulationSolver articulation in _articulated.Solvers)
            articulation.Sweep(isVelocityIteration);
    }

    private void WriteReactions(JointReaction[] reactions)
    {
        _unread?.Invoke(reactions);
        _linkRows.Write(reactions, _dt);
    }

    private int Prepare(double dt)
    {
        ReadOnlySpan<int> joints = _order.Joints;
        double inverseDt = 1 / dt;
        int next = 0;
        int factors = 0;
        for (int b = 0; b < joints.Length; b++)
        {
            JointModel joint = _mechanism.Joints[joints[b]];
            ref JointBlock block = ref _blocks[b];
            SetBodies(ref block, joints[b], joint);
            int count = joint.Prepare(_startPoses[block.Body0], _startPoses[block.Body1], _given);
            Span<int> sorted = _sorted.AsSpan(0, count);
            Preprocessing.Sort(_given.AsSpan(0, count), sorted);
            SetRange(ref block, next, sorted, joint.Preprocessing);
            Load(block, sorted);
            block.Factors = factors;
            factors += Preprocessing.Orthogonalize(_rows, block, _responses.AsSpan(block.Equalities - block.Start), _least);
            SetConstants(block, sorted, joint, dt, inverseDt);
            next = block.End;
        }

        return joints.Length;
    }

    private void SetBodies(ref JointBlock block, int index, JointModel joint)
    {
        int world = _bodies.Count;
        double mass0 = joint.Body0 < 0 ? 0 : _bodies.InverseMasses[joint.Body0];
        double mass1 = joint.Body1 < 0 ? 0 : _bodies.InverseMasses[joint.Body1];
        block.Joint = index;
        block.Body0 = joint.Body0 < 0 ? world : joint.Body0;
        block.Body1 = joint.Body1 < 0 ? world : joint.Body1;
        block.Moved0 = mass0 > 0 ? joint.Body0 : world + 1;
        block.Moved1 = mass1 > 0 ? joint.Body1 : world + 1;
        block.Mass = new PairMass(
            mass0 * joint.InverseMassScale0, mass1 * joint.InverseMassScale1, joint.InverseInertiaScale0, joint.InverseInertiaScale1);
    }

    private void SetRange(ref JointBlock block, int start, ReadOnlySpan<int> sorted, bool isOrthogonal)
    {
        block.Start = start;
        block.End = start + sorted.Length;
        block.Inequalities = block.End;
        block.Equalities = block.End;
        if (isOrthogonal)
        {
            int i = sorted.Length;
            while (i > 0 && _given[sorted[i - 1]].Hint == SolveHint.Inequality)
            {
                i--;
            }

            block.Inequalities = start + i;
            while (i > 0 && _given[sorted[i - 1]].Hint == SolveHint.Equality)
            {
                i--;
            }

            block.Equalities = start + i;
        }
    }

    // Cdot is reckoned with one linear part, as everything after it.
    private void Load(in JointBlock block, ReadOnlySpan<int> sorted)
    {
        int body0 = block.Body0;
        int body1 = block.Body1;
        ref SqrtInertia inertia0 = ref _sqrtInertia[body0];
        ref SqrtInertia inertia1 = ref _sqrtInertia[body1];
        Vector3d relative = _startLinear[body0] - _startLinear[body1];
        Vector3d angular0 = _startAngular[body0];
        Vector3d angular1 = _startAngular[body1];
        for (int i = 0; i < sorted.Length; i++)
        {
            ref ConstraintRow row = ref _given[sorted[i]];
            int index = block.Start + i;
            double velocity = Vector3d.Dot(row.Linear0, relative) + Vector3d.Dot(row.Angular0, angular0) - Vector3d.Dot(row.Angular1, angular1);
            var vectors = new RowVectors
            {
                Linear = new Double4(row.Linear0, row.GeometricError),
                Sqrt0 = inertia0.Times(row.Angular0).With(row.VelocityTarget),
                Sqrt1 = inertia1.Times(row.Angular1).With(velocity),
            };
            _rows.Vectors[index] = vectors;
            _rows.Angular0[index] = row.Angular0;
            _rows.Counts[index] = row.Has(RowFlags.OutputForce);
            _responses[i] = block.Mass.Product(vectors, vectors);
        }
    }

    private void SetConstants(in JointBlock block, ReadOnlySpan<int> sorted, JointModel joint, double dt, double inverseDt)
    {
        for (int i = 0; i < sorted.Length; i++)
        {
            int index = block.Start + i;
            if (index >= block.Equalities && index < block.Inequalities)
            {
                PgsConstants.SetEquality(_rows, index, _responses[i], inverseDt);
                continue;
            }

            ref ConstraintRow row = ref _given[sorted[i]];
            double driveScale = row.Has(RowFlags.HasDriveLimit) && joint.DriveLimitsAreForces ? Math.Min(dt, 1) : 1;
            PgsConstants.Set(_rows, index, _responses[i], row, driveScale, dt, inverseDt);
        }
    }

    private void Sweep(int blocks)
    {
        for (int b = 0; b < blocks; b++)
        {
            ref JointBlock block = ref _blocks[b];
            if (block.Equalities > block.Start)
            {
                _rows.SolveInTurn(block.Start, block.Equalities, block, _deltas);
            }

            if (block.Inequalities > block.Equalities)
            {
                _rows.SolveTogether(block, _deltas);
            }

            if (block.End > block.Inequalities)
            {
                _rows.SolveInTurn(block.Inequalities, block.End, block, _deltas);
            }
        }
    }

    private void Move(int i, double dt)
    {
        if (_bodies.IsKinematic[i])
        {
            _bodies.Poses[i] = _bodies.KinematicTargets[i];
            return;
        }

        Vector3d dv = _deltas[i].Linear.Vector;
        Vector3d du = _deltas[i].Angular.Vector;
        Vector3d motionV = _motions[i].Linear.Vector;
        Vector3d motionU = _motions[i].Angular.Vector;
        BodyLocks locks = _bodies.Locks[i];
        if (locks != BodyLocks.None)
        {
            dv = BodyMotion.Unlocked(dv, locks, BodyLocks.LinearX, BodyLocks.LinearY, BodyLocks.LinearZ);
            du = BodyMotion.Unlocked(du, locks, BodyLocks.AngularX, BodyLocks.AngularY, BodyLocks.AngularZ);
            motionV = BodyMotion.Unlocked(motionV, locks, BodyLocks.LinearX, BodyLocks.LinearY, BodyLocks.LinearZ);
            motionU = BodyMotion.Unlocked(motionU, locks, BodyLocks.AngularX, BodyLocks.AngularY, BodyLocks.AngularZ);
        }

        Vector3d v = _bodies.LinearVelocities[i];
        Vector3d w = _bodies.AngularVelocities[i];
        Pose pose = BodyMotion.Integrate(_bodies.Poses[i], v + motionV, w + _sqrtInertia[i].Times(motionU).Vector, dt);
        v += dv;
        w += _sqrtInertia[i].Times(du).Vector;
        if (!BodyMotion.InRange(pose, v, w))
        {
            _mechanism.Stops++;
            v = Vector3d.Zero;
            w = Vector3d.Zero;
            pose = _bodies.Poses[i];
        }

        _bodies.Poses[i] = pose;
        _bodies.LinearVelocities[i] = v;
        _bodies.AngularVelocities[i] = w;
    }
}
