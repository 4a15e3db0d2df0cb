using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Projected Gauss-Seidel as PhysX 4.1 does it and so Unity: position iterations with the error as bias, whose
/// velocity moves the bodies; then velocity iterations without it, whose velocity is kept. No warm start. Its drift, softness and loss of energy
/// are PhysX's own. Source: DySolverControl.cpp, DyConstraintSetup.cpp, DySolverConstraints.cpp (solve1D), DyBodyCoreIntegrator.h.
/// </summary>
internal sealed class UnitySolver : ISolver
{
    private readonly MultibodySystem _mechanism;
    private readonly Bodies _bodies;
    private readonly SolveOrder _order;
    private readonly ProjectionOrder _projection;
    private readonly CouplingRows _couplings;

    // One more than there are bodies: the last stands for the world and never moves.
    private readonly Vector3d[] _startLinear;
    private readonly Vector3d[] _startAngular;
    private readonly Double4[] _linear;
    private readonly Double4[] _angular;
    private readonly Double4[] _motionLinear;
    private readonly Double4[] _motionAngular;
    private readonly Vector3d[] _rootInertia;
    private readonly SqrtInertia[] _sqrtInertia;

    private readonly JointBlock[] _blocks;
    private readonly PgsRow[] _rows;
    private readonly Preprocessing _preprocessing = new();
    private readonly ConstraintRow[] _scratch = new ConstraintRow[Joint.MaxRows];

    // A joint's rows: springs and motors from Start, then equalities, then inequalities.
    private struct JointBlock
    {
        public int Joint;
        public int Body0;
        public int Body1;
        public int Start;
        public int Equalities;
        public int Inequalities;
        public int End;
        public bool IsOrthogonal;
        public PairMass Mass;

        /// <summary>From body 0's centre of mass to actor 1's anchor.</summary>
        public Vector3d Lever;
    }

    public UnitySolver(MultibodySystem mechanism)
    {
        _mechanism = mechanism;
        _bodies = mechanism.Bodies;
        _order = new SolveOrder(mechanism);
        _projection = new ProjectionOrder(mechanism);
        _couplings = new CouplingRows(mechanism);
        int slots = _bodies.Count + 1;
        _startLinear = new Vector3d[slots];
        _startAngular = new Vector3d[slots];
        _linear = new Double4[slots];
        _angular = new Double4[slots];
        _motionLinear = new Double4[slots];
        _motionAngular = new Double4[slots];
        _rootInertia = Array.ConvertAll(_bodies.InverseInertias, SqrtInertia.Root);
        _sqrtInertia = new SqrtInertia[slots];
        _blocks = new JointBlock[mechanism.Joints.Length];
        _rows = new PgsRow[mechanism.Joints.Length * Joint.MaxRows];
    }

    /// <inheritdoc/>
    public void Step(double dt)
    {
        int positionIterations = 0;
        int velocityIterations = 0;
        for (int i = 0; i < _bodies.Count; i++)
        {
            BodyMotion.PredictVelocity(_bodies, i, _mechanism.Gravity, dt);
            _sqrtInertia[i] = SqrtInertia.At(_bodies.Poses[i].Rotation, _rootInertia[i]);
            _startLinear[i] = _bodies.LinearVelocities[i];
            _startAngular[i] = _bodies.AngularVelocities[i];
            positionIterations = Math.Max(positionIterations, _bodies.PositionIterations[i]);
            velocityIterations = Math.Max(velocityIterations, _bodies.VelocityIterations[i]);
        }

        int blocks = Prepare(dt);
        _couplings.Prepare(_sqrtInertia, dt);
        Array.Clear(_linear, 0, _linear.Length);
        Array.Clear(_angular, 0, _angular.Length);
        for (int i = 0; i < positionIterations; i++)
        {
            Sweep(blocks);
            _couplings.Sweep(_linear, _angular);
        }

        Array.Copy(_linear, _motionLinear, _linear.Length);
        Array.Copy(_angular, _motionAngular, _angular.Length);
        RemoveBias(blocks);
        _couplings.RemoveBias();
        for (int i = 0; i < velocityIterations; i++)
        {
            Sweep(blocks);
            _couplings.Sweep(_linear, _angular);
        }

        Report(blocks, dt);
        for (int i = 0; i < _bodies.Count; i++)
        {
            Move(i, dt);
        }

        _projection.Apply();
        _couplings.Finish();
    }

    private int Prepare(double dt)
    {
        Span<int> order = stackalloc int[Joint.MaxRows];
        Span<double> kept = stackalloc double[Joint.MaxRows];
        ReadOnlySpan<int> joints = _order.Joints;
        double inverseDt = 1 / dt;
        int next = 0;
        for (int b = 0; b < joints.Length; b++)
        {
            Joint joint = _mechanism.Joints[joints[b]];
            int count = joint.Prepare(_bodies.PoseOf(joint.Body0), _bodies.PoseOf(joint.Body1), _scratch);
            Span<ConstraintRow> rows = _scratch.AsSpan(0, count);
            Span<PgsRow> results = _rows.AsSpan(next, count);
            ref JointBlock block = ref _blocks[b];
            SetBodies(ref block, joints[b], joint);
            block.Start = next;
            block.Equalities = next;
            next += count;
            block.Inequalities = next;
            block.End = next;
            Preprocessing.Sort(rows, order);
            for (int i = 0; i < count; i++)
            {
                ref ConstraintRow row = ref rows[order[i]];
                kept[i] = row.Has(RowFlags.KeepBias) ? row.GeometricError : 0;
                Load(ref results[i], row, block);
                block.Equalities += row.Hint < SolveHint.Equality ? 1 : 0;
                block.Inequalities -= row.Hint == SolveHint.Inequality ? 1 : 0;
            }

            if (joint.Preprocessing)
            {
                _preprocessing.Orthogonalize(
                    results.Slice(block.Equalities - block.Start), block.Inequalities - block.Equalities, block.Mass);
            }

            for (int i = 0; i < count; i++)
            {
                ref ConstraintRow row = ref rows[order[i]];
                double driveScale = row.Has(RowFlags.HasDriveLimit) && joint.DriveLimitsAreForces ? Math.Min(dt, 1) : 1;
                PgsConstants.Set(ref results[i], row, kept[i], driveScale, dt, inverseDt);
            }
        }

        return joints.Length;
    }

    private void SetBodies(ref JointBlock block, int index, Joint joint)
    {
        int world = _bodies.Count;
        double mass0 = joint.Body0 < 0 ? 0 : _bodies.InverseMasses[joint.Body0];
        double mass1 = joint.Body1 < 0 ? 0 : _bodies.InverseMasses[joint.Body1];
        block.Joint = index;
        block.Body0 = joint.Body0 < 0 ? world : joint.Body0;
        block.Body1 = joint.Body1 < 0 ? world : joint.Body1;
        block.Mass = new PairMass(
            mass0 * joint.InverseMassScale0, mass1 * joint.InverseMassScale1, joint.InverseInertiaScale0, joint.InverseInertiaScale1);
        block.IsOrthogonal = joint.Preprocessing;
        block.Lever = _bodies.PoseOf(joint.Body1).Point(joint.Frame1.Position) - _bodies.PoseOf(joint.Body0).Position;
    }

    private void Load(ref PgsRow result, in ConstraintRow row, in JointBlock block)
    {
        int body0 = block.Body0;
        int body1 = block.Body1;
        double velocity = row.Velocity(_startLinear[body0], _startAngular[body0], _startLinear[body1], _startAngular[body1]);
        result.Linear = new Double4(row.Linear0, row.GeometricError);
        result.Sqrt0 = new Double4(_sqrtInertia[body0].Times(row.Angular0), row.VelocityTarget);
        result.Sqrt1 = new Double4(_sqrtInertia[body1].Times(row.Angular1), velocity);
        result.Angular0 = new Double4(row.Angular0, 0);
        result.Response = block.Mass.Product(result, result);
        result.Counts = row.Has(RowFlags.OutputForce);
    }

    private void Sweep(int blocks)
    {
        for (int b = 0; b < blocks; b++)
        {
            ref JointBlock block = ref _blocks[b];
            var pair = new PairVelocity(_linear[block.Body0], _angular[block.Body0], _linear[block.Body1], _angular[block.Body1]);
            if (block.Equalities > block.Start)
            {
                pair.SolveInTurn(_rows.AsSpan(block.Start, block.Equalities - block.Start), block.Mass);
            }

            Span<PgsRow> equalities = _rows.AsSpan(block.Equalities, block.Inequalities - block.Equalities);
            if (block.IsOrthogonal)
            {
                pair.SolveTogether(equalities, block.Mass);
            }
            else
            {
                pair.SolveInTurn(equalities, block.Mass);
            }

            if (block.End > block.Inequalities)
            {
                pair.SolveInTurn(_rows.AsSpan(block.Inequalities, block.End - block.Inequalities), block.Mass);
            }

            _linear[block.Body0] = pair.Linear0;
            _angular[block.Body0] = pair.Angular0;
            _linear[block.Body1] = pair.Linear1;
            _angular[block.Body1] = pair.Angular1;
        }
    }

    private void RemoveBias(int blocks)
    {
        int end = blocks > 0 ? _blocks[blocks - 1].End : 0;
        for (int i = 0; i < end; i++)
        {
            _rows[i].Constant = _rows[i].UnbiasedConstant;
        }
    }

    // Force and torque of the rows that count, moved to the anchor; a joint that passes its limits acted in full in
    // this step and is gone in the next. Source: DySolverConstraints.cpp, writeBack1D.
    private void Report(int blocks, double dt)
    {
        double inverseDt = 1 / dt;
        bool broken = false;
        for (int b = 0; b < blocks; b++)
        {
            ref JointBlock block = ref _blocks[b];
            Vector3d linear = Vector3d.Zero;
            Vector3d angular = Vector3d.Zero;
            for (int i = block.Start; i < block.End; i++)
            {
                if (_rows[i].Counts)
                {
                    linear += _rows[i].Linear.Vector * _rows[i].Impulse;
                    angular += _rows[i].Angular0.Vector * _rows[i].Impulse;
                }
            }

            angular -= Vector3d.Cross(block.Lever, linear);
            Joint joint = _mechanism.Joints[block.Joint];
            _mechanism.Reactions[block.Joint] = new JointReaction { Force = linear * inverseDt, Torque = angular * inverseDt };
            if (Exceeds(linear, joint.BreakForce * dt) || Exceeds(angular, joint.BreakTorque * dt))
            {
                joint.IsBroken = true;
                broken = true;
            }
        }

        if (broken)
        {
            _order.Refresh();
            _projection.Refresh();
        }
    }

    private static bool Exceeds(Vector3d impulse, double limit) => impulse.LengthSquared > limit * limit;

    private void Move(int i, double dt)
    {
        if (_bodies.IsKinematic[i])
        {
            _bodies.Poses[i] = _bodies.KinematicTargets[i];
            return;
        }

        Vector3d dv = _linear[i].Vector;
        Vector3d du = _angular[i].Vector;
        Vector3d motionV = _motionLinear[i].Vector;
        Vector3d motionU = _motionAngular[i].Vector;
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
        Pose pose = BodyMotion.Integrate(_bodies.Poses[i], v + motionV, w + _sqrtInertia[i].Times(motionU), dt);
        v += dv;
        w += _sqrtInertia[i].Times(du);
        if (!BodyMotion.InRange(pose, v, w))
        {
            _mechanism.Overflows++;
            v = Vector3d.Zero;
            w = Vector3d.Zero;
            pose = _bodies.Poses[i];
        }

        _bodies.Poses[i] = pose;
        _bodies.LinearVelocities[i] = v;
        _bodies.AngularVelocities[i] = w;
    }
}
