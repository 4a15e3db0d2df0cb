using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Makes the rows of the sweeps from those that joints give. Of the parts of a step each has one, since it has room for a joint's rows.
/// Source: DyConstraintSetup.cpp.
/// </summary>
internal sealed class JointPreparation
{
    private readonly MultibodySystem _mechanism;
    private readonly Bodies _bodies;
    private readonly JointBlock[] _blocks;
    private readonly SweepRows _rows;

    // Of the bodies at the start of the step, and one for the world.
    private readonly Pose[] _startPoses;
    private readonly Vector3d[] _startLinear;
    private readonly Vector3d[] _startAngular;
    private readonly SqrtInertia[] _sqrtInertia;
    private readonly int _unread;

    // One joint's rows on their way into the sweeps.
    private readonly ConstraintRow[] _given = new ConstraintRow[JointModel.MaxRows];
    private readonly int[] _sorted = new int[JointModel.MaxRows];
    private readonly double[] _responses = new double[JointModel.MaxRows];
    private readonly double[] _least = new double[JointModel.MaxRows];

    /// <param name="mechanism">Whose joints.</param>
    /// <param name="blocks">Where to, a joint each.</param>
    /// <param name="rows">Where to.</param>
    /// <param name="startPoses">Of the bodies, and of the world behind them; so too the next.</param>
    /// <param name="startLinear">m/s.</param>
    /// <param name="startAngular">rad/s.</param>
    /// <param name="sqrtInertia">Roots of the inverse inertias.</param>
    /// <param name="unread">See <see cref="JointBlock.Moved0"/>.</param>
    public JointPreparation(
        MultibodySystem mechanism, JointBlock[] blocks, SweepRows rows, Pose[] startPoses, Vector3d[] startLinear, Vector3d[] startAngular, SqrtInertia[] sqrtInertia, int unread)
    {
        _mechanism = mechanism;
        _bodies = mechanism.Bodies;
        _blocks = blocks;
        _rows = rows;
        _startPoses = startPoses;
        _startLinear = startLinear;
        _startAngular = startAngular;
        _sqrtInertia = sqrtInertia;
        _unread = unread;
    }

    /// <summary>The rows of the joints of a part of the order, at the poses and velocities where the step starts.</summary>
    /// <param name="joints">Of all parts, in their order.</param>
    /// <param name="first">Of the part.</param>
    /// <param name="end">After its last.</param>
    /// <param name="dt">Step, s.</param>
    public void Prepare(ReadOnlySpan<int> joints, int first, int end, double dt)
    {
        double inverseDt = 1 / dt;
        int next = first * JointModel.MaxRows;
        int factors = first * SweepRows.MaxFactors;
        for (int b = first; b < end; b++)
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
    }

    private void SetBodies(ref JointBlock block, int index, JointModel joint)
    {
        int world = _bodies.Count;
        double mass0 = joint.Body0 < 0 ? 0 : _bodies.InverseMasses[joint.Body0];
        double mass1 = joint.Body1 < 0 ? 0 : _bodies.InverseMasses[joint.Body1];
        block.Joint = index;
        block.Body0 = joint.Body0 < 0 ? world : joint.Body0;
        block.Body1 = joint.Body1 < 0 ? world : joint.Body1;
        block.Moved0 = mass0 > 0 ? joint.Body0 : _unread;
        block.Moved1 = mass1 > 0 ? joint.Body1 : _unread;
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
}
