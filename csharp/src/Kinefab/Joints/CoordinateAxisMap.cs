using System;
using Kinefab.Numerics;

namespace Kinefab.Joints;

/// <summary>
/// A scalar coordinate of a joint: Sign times frame 1's offset along, or angle about, an axis of frame 0, metres or
/// radians. An angle is the twist about that axis: what is left of a ball's turn when the axis is brought back along the shortest arc.
/// </summary>
internal readonly struct CoordinateAxisMap
{
    public readonly JointModel Joint;
    public readonly CoordinateAxis Axis;

    /// <summary>1, or -1 when the coordinate is that of actor 0 against actor 1.</summary>
    public readonly double Sign;

    public CoordinateAxisMap(JointModel joint, CoordinateAxis axis, double sign)
    {
        Joint = joint;
        Axis = axis;
        Sign = sign;
    }

    public bool IsAngle => Axis >= CoordinateAxis.AngularX;

    /// <summary>
    /// q and the row of its rate: qdot = row.Velocity(v0, w0, v1, w1).
    /// Linear: q = s c.p_i, J = -s (a, r0 x a; a, r1 x a). Angular: q = 2 s atan2(c.q_i, c.q_w),
    /// J = -s (0, g; 0, g), g of <see cref="SwingTwist.TwistGradient"/>, which of a hinge is its axis.
    /// </summary>
    /// <param name="body0">Pose of the joint's body 0.</param>
    /// <param name="body1">Pose of the joint's body 1.</param>
    /// <param name="near">Of the angles that differ by whole turns the one nearest to this is taken.</param>
    /// <param name="row">Only its J and GeometricError (= q) hold.</param>
    public double Evaluate(in Pose body0, in Pose body1, double near, out ConstraintRow row)
    {
        Joint.FramesAt(body0, body1, out JointFrames f);
        row = default;
        if (!IsAngle)
        {
            int i = (int)Axis;
            Vector3d a = f.Axis0(i) * -Sign;
            row.Linear0 = a;
            row.Angular0 = Vector3d.Cross(f.P1 - body0.Position, a);
            row.Angular1 = Vector3d.Cross(f.P1 - body1.Position, a);
            row.GeometricError = Sign * f.Relative.Position[i];
            return row.GeometricError;
        }

        return EvaluateAngle(f, near, out row);
    }

    /// <summary>The same of an angle.</summary>
    /// <param name="f">The joint's frames.</param>
    /// <param name="near">Of the angles that differ by whole turns the one nearest to this is taken.</param>
    /// <param name="row">Only its J and GeometricError (= q) hold.</param>
    public double EvaluateAngle(in JointFrames f, double near, out ConstraintRow row)
    {
        row = default;
        int axis = Axis - CoordinateAxis.AngularX;
        row.Angular0 = (Joint is RevoluteJoint ? f.Axis0(axis) : Gradient(f, axis)) * -Sign;
        row.Angular1 = row.Angular0;
        row.Flags = RowFlags.Angular;
        Quaterniond q = f.Relative.Rotation;
        double angle = Sign * 2 * Trigonometry.Atan2(q.Vector[axis], q.W);
        row.GeometricError = SwingTwist.Nearest(angle, near);
        return row.GeometricError;
    }

    private static Vector3d Gradient(in JointFrames f, int axis)
    {
        f.Axes1(out Vector3d x1, out Vector3d y1, out Vector3d z1);
        return SwingTwist.TwistGradient(f.Axis0(axis), axis == 0 ? x1 : axis == 1 ? y1 : z1);
    }
}
