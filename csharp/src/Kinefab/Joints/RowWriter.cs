using System;
using Kinefab.Numerics;

namespace Kinefab.Joints;

/// <summary>
/// Writes rows in the families that PhysX's joints share (ExtConstraintHelper.h). Levers are taken from both centres
/// of mass to actor 1's anchor, so that a linear row's Cdot is exact while the anchors are apart.
/// </summary>
internal ref struct RowWriter
{
    private readonly Span<ConstraintRow> _rows;
    private readonly Vector3d _lever0;
    private readonly Vector3d _lever1;
    private readonly bool _everyLimit;

    /// <summary>Rows written so far.</summary>
    public int Count { get; private set; }

    public RowWriter(Span<ConstraintRow> rows, Vector3d anchor1, Vector3d center0, Vector3d center1, bool everyLimit)
    {
        _everyLimit = everyLimit;
        _rows = rows;
        _lever0 = anchor1 - center0;
        _lever1 = anchor1 - center1;
        Count = 0;
    }

    /// <summary>
    /// Rigid rows on the joint axes named by two bit masks.
    /// Linear, axis a of frame 0: C = -c.p.a; Cdot = a.(v0 + w0 x r0) - a.(v1 + w1 x r1); J = (a, r0 x a; a, r1 x a),
    /// where r0 ends at frame 1's origin less its error along the locked axes.
    /// Angular, component i of the quaternion c: C = -c.q_i; Cdot = row_i.(w0 - w1) with row = 1/2 L(q0*) R(q1).
    /// Source: ExtConstraintHelper.h, prepareLockedAxes and computeJacobianAxes.
    /// </summary>
    public void Locked(in JointFrames f, int linear, int angular)
    {
        if (linear != 0)
        {
            bool x = (linear & 1) != 0;
            bool y = (linear & 2) != 0;
            bool z = (linear & 4) != 0;
            Vector3d p = f.Relative.Position;
            Vector3d error = Vector3d.Zero;
            error -= x ? f.Axis0(0) * p.X : Vector3d.Zero;
            error -= y ? f.Axis0(1) * p.Y : Vector3d.Zero;
            error -= z ? f.Axis0(2) * p.Z : Vector3d.Zero;
            Vector3d lever0 = _lever0 + error;
            if (x)
            {
                LinearRow(f.Axis0(0), lever0, _lever1, -p.X, RowFlags.OutputForce, SolveHint.Equality);
            }

            if (y)
            {
                LinearRow(f.Axis0(1), lever0, _lever1, -p.Y, RowFlags.OutputForce, SolveHint.Equality);
            }

            if (z)
            {
                LinearRow(f.Axis0(2), lever0, _lever1, -p.Z, RowFlags.OutputForce, SolveHint.Equality);
            }
        }

        if (angular != 0)
        {
            JointFrames.QuaternionAxes(f.Q0, f.Q1, out Vector3d x, out Vector3d y, out Vector3d z);
            Quaterniond q = f.Relative.Rotation;
            if ((angular & 1) != 0)
            {
                LockedAngle(x, -q.X);
            }

            if ((angular & 2) != 0)
            {
                LockedAngle(y, -q.Y);
            }

            if ((angular & 4) != 0)
            {
                LockedAngle(z, -q.Z);
            }
        }
    }

    /// <summary>A rigid row on the angular velocity along an axis: J = (0, axis; 0, axis).</summary>
    public void LockedAngle(Vector3d axis, double error) => AngularRow(axis, error, RowFlags.OutputForce, SolveHint.Equality);

    /// <summary>
    /// Upper limit of an ordinate that grows with frame 1's motion along the axis.
    /// C = limit - ordinate >= 0; Cdot = a.(velocity of body 0 at the anchor - velocity of body 1); impulse >= 0.
    /// </summary>
    public void UpperLimit(Vector3d axis, double ordinate, double limit, in LimitResponse response)
    {
        double pad = _everyLimit ? double.PositiveInfinity : response.IsSoft ? 0 : response.ContactDistance;
        if (ordinate + pad > limit)
        {
            Limit(ref LinearRow(axis, _lever0, _lever1, limit - ordinate), response);
        }
    }

    /// <summary>
    /// Both limits of an angle of frame 1 against frame 0 about the axis.
    /// Lower: C = angle - lower, J = -axis; upper: C = upper - angle, J = axis; Cdot = J.(w0 - w1); impulse >= 0.
    /// </summary>
    public void AngleLimits(Vector3d axis, double angle, double lower, double upper, in LimitResponse response)
    {
        double pad = _everyLimit ? double.PositiveInfinity : response.IsSoft ? 0 : response.ContactDistance;
        if (angle < lower + pad)
        {
            Limit(ref AngularRow(-axis, angle - lower), response);
        }

        if (angle > upper - pad)
        {
            Limit(ref AngularRow(axis, upper - angle), response);
        }
    }

    /// <summary>
    /// Both limits of a twist, however far: C = c times the twist that is left to them, c = cos(swing / 2), the same limits by a J that is a unit vector at any
    /// swing, see <see cref="SwingTwist.WeighedGradient"/>. PhysX's soft limit has the torque k C / c along X1, which has no potential; the gradient of the
    /// angle itself would be k C / c^2.
    /// </summary>
    public void WeighedTwistLimits(Vector3d axis0, Vector3d axis1, double angle, in AngularLimit limit)
    {
        Vector3d lower = SwingTwist.WeighedGradient(axis0, axis1, limit.Lower - angle, out double weight);
        Vector3d upper = SwingTwist.WeighedGradient(axis0, axis1, limit.Upper - angle, out _);
        Limit(ref AngularRow(-lower, weight * (angle - limit.Lower)), limit.Response);
        Limit(ref AngularRow(upper, weight * (limit.Upper - angle)), limit.Response);
    }

    /// <summary>A cone's limit, whose error is known, positive inside: J = (0, axis; 0, axis), impulse >= 0.</summary>
    public void ConeLimit(Vector3d axis, double error, in LimitResponse response)
    {
        ref ConstraintRow row = ref AngularRow(axis, error);
        row.Flags |= RowFlags.Cone;
        Limit(ref row, response);
    }

    /// <summary>Spring-damper along a line through frame 1's origin: C = target - ordinate, J as a linear row.</summary>
    public void LinearDrive(Vector3d axis, double velocityTarget, double error, in DriveModel drive) =>
        Drive(ref LinearRow(axis, _lever0, _lever1, error), velocityTarget, drive, Prescribed(drive));

    /// <summary>The spring of a soft limit of no width, along a line through frame 1's origin: a drive to 0 whose force is the joint's.</summary>
    public void Spring(Vector3d axis, double error, in LimitResponse response)
    {
        ref ConstraintRow row = ref LinearRow(axis, _lever0, _lever1, error, RowFlags.OutputForce);
        Drive(ref row, 0, new DriveModel { Stiffness = response.Stiffness, Damping = response.Damping, ForceLimit = double.PositiveInfinity }, default);
    }

    /// <summary>Spring-damper on the relative angular velocity along an axis.</summary>
    public void AngularDrive(Vector3d axis, double velocityTarget, double error, in DriveModel drive, SolveHint hint = SolveHint.None, double weight = 1)
    {
        Drive(ref AngularRow(axis, error, hint: hint), velocityTarget, drive, Prescribed(drive), weight);
    }

    /// <summary>A velocity motor: Cdot = J.(w0 - w1) with J = -axis is driven to the target within the limits.</summary>
    public void Motor(Vector3d axis, double velocityTarget, double minimum, double maximum)
    {
        ref ConstraintRow row = ref AngularRow(-axis, 0);
        row.VelocityTarget = velocityTarget;
        row.Minimum = minimum;
        row.Maximum = maximum;
        row.Flags |= RowFlags.HasDriveLimit | RowFlags.Drive;
    }

    private static void Limit(ref ConstraintRow row, in LimitResponse response)
    {
        row.Flags |= RowFlags.OutputForce | RowFlags.Limit;
        row.Minimum = 0;
        if (response.IsSoft)
        {
            row.Flags |= RowFlags.Spring;
            row.Stiffness = response.Stiffness;
            row.Damping = response.Damping;
            return;
        }

        row.Hint = SolveHint.Inequality;
        row.Restitution = response.Restitution;
        row.BounceThreshold = response.BounceThreshold;
        if (row.GeometricError > 0)
        {
            row.Flags |= RowFlags.KeepBias;
        }

        if (response.Restitution > 0)
        {
            row.Flags |= RowFlags.Restitution;
        }
    }

    /// <summary>What a drive's rows prescribe.</summary>
    public Prescribed Prescribed(in DriveModel drive) => _everyLimit ? drive.Prescribes : default;

    private static void Drive(ref ConstraintRow row, double velocityTarget, in DriveModel drive, Prescribed prescribed, double weight = 1)
    {
        row.Minimum = -drive.ForceLimit;
        row.Maximum = drive.ForceLimit;
        row.VelocityTarget = velocityTarget;
        row.Flags |= RowFlags.HasDriveLimit | RowFlags.Drive;
        if (prescribed == Joints.Prescribed.Position)
        {
            row.Stiffness = drive.Stiffness / drive.Damping;
            row.VelocityTarget = -row.Stiffness * row.GeometricError;
            row.Weight = weight;
            row.Flags |= RowFlags.Motion;
        }

        if (prescribed != Joints.Prescribed.Nothing)
        {
            return;
        }

        row.Flags |= RowFlags.Spring;
        if (drive.IsAcceleration)
        {
            row.Flags |= RowFlags.AccelerationSpring;
        }

        row.Stiffness = drive.Stiffness;
        row.Damping = drive.Damping;
    }

    private ref ConstraintRow LinearRow(
        Vector3d axis, Vector3d lever0, Vector3d lever1, double error, RowFlags flags = RowFlags.None, SolveHint hint = SolveHint.None)
    {
        ref ConstraintRow row = ref Next(error, flags, hint);
        row.Linear0 = axis;
        row.Angular0 = Vector3d.Cross(lever0, axis);
        row.Angular1 = Vector3d.Cross(lever1, axis);
        return ref row;
    }

    private ref ConstraintRow AngularRow(Vector3d axis, double error, RowFlags flags = RowFlags.None, SolveHint hint = SolveHint.None)
    {
        ref ConstraintRow row = ref Next(error, flags | RowFlags.Angular, hint);
        row.Linear0 = Vector3d.Zero;
        row.Angular0 = axis;
        row.Angular1 = axis;
        return ref row;
    }

    // Everything but the vectors and what only springs and bouncing limits have. Clearing the row first costs more than the rest of it.
    private ref ConstraintRow Next(double error, RowFlags flags, SolveHint hint)
    {
        ref ConstraintRow row = ref _rows[Count++];
        row.GeometricError = error;
        row.VelocityTarget = 0;
        row.Minimum = double.NegativeInfinity;
        row.Maximum = double.PositiveInfinity;
        row.Flags = flags;
        row.Hint = hint;
        return ref row;
    }
}
