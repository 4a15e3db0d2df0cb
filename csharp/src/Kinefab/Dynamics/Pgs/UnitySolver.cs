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
    private readonly Mechanism _mechanism;
    private readonly Bodies _bodies;
    private readonly SolveOrder _order;
    private readonly ProjectionOrder _projection;
    private readonly CouplingRows _couplings;

    // One more than there are bodies: the last stands for the world and never moves.
    private readonly Vector3d[] _linear;
    private readonly Vector3d[] _angular;
    private readonly Vector3d[] _motionLinear;
    private readonly Vector3d[] _motionAngular;
    private readonly SqrtInertia[] _sqrtInertia;

    private readonly JointBlock[] _blocks;
    private readonly PgsRow[] _rows;
    private readonly RowOutput[] _outputs;
    private readonly ConstraintRow[] _scratch = new ConstraintRow[Joint.MaxRows];

    private struct JointBlock
    {
        public int Joint;
        public int Body0;
        public int Body1;
        public int Start;
        public int End;
        public PairMass Mass;
        public Vector3d Anchor;
    }

    /// <summary>What is needed of a row to report its force; the angular part before the square root of the inertia.</summary>
    private struct RowOutput
    {
        public Vector3d Angular0;
        public bool Counts;
    }

    public UnitySolver(Mechanism mechanism)
    {
        _mechanism = mechanism;
        _bodies = mechanism.Bodies;
        _order = new SolveOrder(mechanism);
        _projection = new ProjectionOrder(mechanism);
        _couplings = new CouplingRows(mechanism);
        int slots = _bodies.Count + 1;
        _linear = new Vector3d[slots];
        _angular = new Vector3d[slots];
        _motionLinear = new Vector3d[slots];
        _motionAngular = new Vector3d[slots];
        _sqrtInertia = new SqrtInertia[slots];
        _blocks = new JointBlock[mechanism.Joints.Length];
        _rows = new PgsRow[mechanism.Joints.Length * Joint.MaxRows];
        _outputs = new RowOutput[_rows.Length];
    }

    /// <inheritdoc/>
    public void Step(double dt)
    {
        int positionIterations = 0;
        int velocityIterations = 0;
        for (int i = 0; i < _bodies.Count; i++)
        {
            BodyMotion.PredictVelocity(_bodies, i, _mechanism.Gravity, dt);
            _sqrtInertia[i] = SqrtInertia.At(_bodies.Poses[i].Rotation, _bodies.InverseInertias[i]);
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
        Span<Vector3d> s0 = stackalloc Vector3d[Joint.MaxRows];
        Span<Vector3d> s1 = stackalloc Vector3d[Joint.MaxRows];
        Span<double> kept = stackalloc double[Joint.MaxRows];
        int next = 0;
        for (int b = 0; b < _order.Joints.Count; b++)
        {
            int index = _order.Joints[b];
            Joint joint = _mechanism.Joints[index];
            int count = joint.Prepare(_bodies.PoseOf(joint.Body0), _bodies.PoseOf(joint.Body1), _scratch);
            Span<ConstraintRow> rows = _scratch.AsSpan(0, count);
            ref JointBlock block = ref _blocks[b];
            block = Block(index, joint, next, next + count);
            Preprocessing.Sort(rows, order);
            for (int i = 0; i < count; i++)
            {
                ref ConstraintRow row = ref rows[order[i]];
                kept[i] = row.Has(RowFlags.KeepBias) ? row.GeometricError : 0;
                s0[i] = _sqrtInertia[block.Body0].Times(row.Angular0);
                s1[i] = _sqrtInertia[block.Body1].Times(row.Angular1);
            }

            if (joint.Preprocessing)
            {
                Preprocessing.Orthogonalize(rows, order.Slice(0, count), s0, s1, block.Mass);
            }

            for (int i = 0; i < count; i++)
            {
                ref ConstraintRow row = ref rows[order[i]];
                ref PgsRow result = ref _rows[next];
                result.Linear = row.Linear0;
                result.Angular0 = s0[i];
                result.Angular1 = s1[i];
                double response = row.Linear0.LengthSquared * (block.Mass.InverseMass0 + block.Mass.InverseMass1)
                    + s0[i].LengthSquared * block.Mass.InertiaScale0 + s1[i].LengthSquared * block.Mass.InertiaScale1;
                double driveScale = row.Has(RowFlags.HasDriveLimit) && joint.DriveLimitsAreForces ? Math.Min(dt, 1) : 1;
                PgsConstants.Set(ref result, row, kept[i], response, StartVelocity(joint, row), driveScale, dt);
                _outputs[next].Angular0 = row.Angular0;
                _outputs[next].Counts = row.Has(RowFlags.OutputForce);
                next++;
            }
        }

        return _order.Joints.Count;
    }

    private JointBlock Block(int index, Joint joint, int start, int end)
    {
        int world = _bodies.Count;
        double mass0 = joint.Body0 < 0 ? 0 : _bodies.InverseMasses[joint.Body0];
        double mass1 = joint.Body1 < 0 ? 0 : _bodies.InverseMasses[joint.Body1];
        Vector3d anchor1 = (_bodies.PoseOf(joint.Body1) * joint.Frame1).Position;
        return new JointBlock
        {
            Joint = index,
            Body0 = joint.Body0 < 0 ? world : joint.Body0,
            Body1 = joint.Body1 < 0 ? world : joint.Body1,
            Start = start,
            End = end,
            Mass = new PairMass(
                mass0 * joint.InverseMassScale0, mass1 * joint.InverseMassScale1, joint.InverseInertiaScale0, joint.InverseInertiaScale1),
            Anchor = anchor1 - _bodies.PoseOf(joint.Body0).Position,
        };
    }

    private double StartVelocity(Joint joint, in ConstraintRow row)
    {
        Vector3d v0 = joint.Body0 < 0 ? Vector3d.Zero : _bodies.LinearVelocities[joint.Body0];
        Vector3d w0 = joint.Body0 < 0 ? Vector3d.Zero : _bodies.AngularVelocities[joint.Body0];
        Vector3d v1 = joint.Body1 < 0 ? Vector3d.Zero : _bodies.LinearVelocities[joint.Body1];
        Vector3d w1 = joint.Body1 < 0 ? Vector3d.Zero : _bodies.AngularVelocities[joint.Body1];
        return row.Velocity(v0, w0, v1, w1);
    }

    private void Sweep(int blocks)
    {
        for (int b = 0; b < blocks; b++)
        {
            ref JointBlock block = ref _blocks[b];
            Vector3d v0 = _linear[block.Body0];
            Vector3d v1 = _linear[block.Body1];
            Vector3d u0 = _angular[block.Body0];
            Vector3d u1 = _angular[block.Body1];
            for (int i = block.Start; i < block.End; i++)
            {
                ref PgsRow row = ref _rows[i];
                double velocity = Vector3d.Dot(row.Linear, v0 - v1) + Vector3d.Dot(row.Angular0, u0) - Vector3d.Dot(row.Angular1, u1);
                double impulse = row.ImpulseMultiplier * row.Impulse + row.VelocityMultiplier * velocity + row.Constant;
                impulse = Math.Min(row.Maximum, Math.Max(row.Minimum, impulse));
                double delta = impulse - row.Impulse;
                row.Impulse = impulse;
                v0 += row.Linear * (delta * block.Mass.InverseMass0);
                v1 -= row.Linear * (delta * block.Mass.InverseMass1);
                u0 += row.Angular0 * (delta * block.Mass.InertiaScale0);
                u1 -= row.Angular1 * (delta * block.Mass.InertiaScale1);
            }

            _linear[block.Body0] = v0;
            _linear[block.Body1] = v1;
            _angular[block.Body0] = u0;
            _angular[block.Body1] = u1;
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
        bool broken = false;
        for (int b = 0; b < blocks; b++)
        {
            ref JointBlock block = ref _blocks[b];
            Vector3d linear = Vector3d.Zero;
            Vector3d angular = Vector3d.Zero;
            for (int i = block.Start; i < block.End; i++)
            {
                if (_outputs[i].Counts)
                {
                    linear += _rows[i].Linear * _rows[i].Impulse;
                    angular += _outputs[i].Angular0 * _rows[i].Impulse;
                }
            }

            angular -= Vector3d.Cross(block.Anchor, linear);
            Joint joint = _mechanism.Joints[block.Joint];
            _mechanism.Reactions[block.Joint] = new JointReaction { Force = linear * (1 / dt), Torque = angular * (1 / dt) };
            if (linear.Length > joint.BreakForce * dt || angular.Length > joint.BreakTorque * dt)
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

    private void Move(int i, double dt)
    {
        if (_bodies.IsKinematic[i])
        {
            _bodies.Poses[i] = _bodies.KinematicTargets[i];
            return;
        }

        BodyLocks locks = _bodies.Locks[i];
        if (locks != BodyLocks.None)
        {
            _motionLinear[i] = BodyMotion.Unlocked(_motionLinear[i], locks, BodyLocks.LinearX, BodyLocks.LinearY, BodyLocks.LinearZ);
            _linear[i] = BodyMotion.Unlocked(_linear[i], locks, BodyLocks.LinearX, BodyLocks.LinearY, BodyLocks.LinearZ);
            _motionAngular[i] = BodyMotion.Unlocked(_motionAngular[i], locks, BodyLocks.AngularX, BodyLocks.AngularY, BodyLocks.AngularZ);
            _angular[i] = BodyMotion.Unlocked(_angular[i], locks, BodyLocks.AngularX, BodyLocks.AngularY, BodyLocks.AngularZ);
        }

        Vector3d v = _bodies.LinearVelocities[i] + _motionLinear[i];
        Vector3d w = _bodies.AngularVelocities[i] + _sqrtInertia[i].Times(_motionAngular[i]);
        Pose pose = BodyMotion.Integrate(_bodies.Poses[i], v, w, dt);
        v = _bodies.LinearVelocities[i] + _linear[i];
        w = _bodies.AngularVelocities[i] + _sqrtInertia[i].Times(_angular[i]);
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
