using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Joint projection: the relative pose of the frames is cut back to the tolerances and one body moved to match.
/// Source: ExtConstraintHelper.h (truncateLinear, truncateAngular, projectTransforms), ExtD6Joint.cpp, ExtRevoluteJoint.cpp.
/// </summary>
internal static class Projections
{
    /// <summary>Moves one body back within the joint's projection tolerances; true when it had to.</summary>
    /// <param name="joint">With its bodies at the poses.</param>
    /// <param name="body0">Pose of body 0; changed when <paramref name="moveBody1"/> is false.</param>
    /// <param name="body1">Pose of body 1; changed when <paramref name="moveBody1"/> is true.</param>
    /// <param name="moveBody1">Which of the two is moved.</param>
    public static bool Apply(JointModel joint, ref Pose body0, ref Pose body1, bool moveBody1) => joint switch
    {
        RevoluteJoint revolute => Revolute(revolute, ref body0, ref body1, moveBody1),
        D6Joint d6 => D6(d6, ref body0, ref body1, moveBody1),
        _ => false,
    };

    /// <summary>Projects the anchors' distance and the swing.</summary>
    public static bool Revolute(RevoluteJoint joint, ref Pose body0, ref Pose body1, bool moveBody1)
    {
        Pose f0 = body0 * joint.Frame0;
        Pose f1 = body1 * joint.Frame1;
        Pose c = f0.Inverse() * f1;
        Vector3d p = Truncate(c.Position, joint.ProjectionLinearTolerance, out bool linear);
        var parts = new SwingTwist(c.Rotation);
        double sine = Trigonometry.Sin(joint.ProjectionAngularTolerance / 2);
        Quaterniond swing = parts.Swing;
        bool angular = false;
        // Above this sine the tolerance is all but half a turn and nothing is cut.
        if (sine <= 0.9999)
        {
            Quaterniond near = swing.W >= 0 ? swing : JointFrames.Negate(swing);
            double length = near.Vector.Length;
            if (length > sine)
            {
                Vector3d v = near.Vector * (sine / length);
                swing = new Quaterniond(v.X, v.Y, v.Z, Trigonometry.Cos(joint.ProjectionAngularTolerance / 2));
                angular = true;
            }
        }

        if (linear || angular)
        {
            Move(joint, ref body0, ref body1, f0, f1, new Pose(p, swing * parts.Twist), moveBody1);
        }

        return linear || angular;
    }

    /// <summary>Projects the locked axes; an angle locked alone is left as it is, as in PhysX.</summary>
    public static bool D6(D6Joint joint, ref Pose body0, ref Pose body1, bool moveBody1)
    {
        Pose f0 = body0 * joint.Frame0;
        Pose f1 = body1 * joint.Frame1;
        Pose c = f0.Inverse() * f1;
        var locked = new Vector3d(
            joint.X == AxisMotion.Locked ? c.Position.X : 0,
            joint.Y == AxisMotion.Locked ? c.Position.Y : 0,
            joint.Z == AxisMotion.Locked ? c.Position.Z : 0);
        Vector3d p = Truncate(locked, joint.ProjectionLinearTolerance, out bool linear) + (c.Position - locked);

        bool twist = joint.Twist == AxisMotion.Locked;
        bool swing1 = joint.Swing1 == AxisMotion.Locked;
        bool swing2 = joint.Swing2 == AxisMotion.Locked;
        double cosine = Trigonometry.Cos(joint.ProjectionAngularTolerance / 2);
        bool angular = false;
        Quaterniond q = c.Rotation;
        if (twist && swing1 && swing2)
        {
            q = Truncate(q, cosine, out angular);
        }
        else if (swing1 && swing2)
        {
            q = AboutFreeAxis(q, Vector3d.UnitX, cosine, out angular);
        }
        else if (twist && swing2)
        {
            q = AboutFreeAxis(q, Vector3d.UnitY, cosine, out angular);
        }
        else if (twist && swing1)
        {
            q = AboutFreeAxis(q, Vector3d.UnitZ, cosine, out angular);
        }

        if (linear || angular)
        {
            Move(joint, ref body0, ref body1, f0, f1, new Pose(p, q), moveBody1);
        }

        return linear || angular;
    }

    private static void Move(JointModel joint, ref Pose body0, ref Pose body1, in Pose f0, in Pose f1, in Pose relative, bool moveBody1)
    {
        Pose moved = moveBody1
            ? f0 * relative * joint.Frame1.Inverse()
            : f1 * relative.Inverse() * joint.Frame0.Inverse();
        moved = new Pose(moved.Position, moved.Rotation.Normalized());
        if (moveBody1)
        {
            body1 = moved;
        }
        else
        {
            body0 = moved;
        }
    }

    private static Vector3d Truncate(Vector3d v, double tolerance, out bool truncated)
    {
        truncated = v.LengthSquared > tolerance * tolerance;
        return truncated ? v.Normalized() * tolerance : v;
    }

    private static Quaterniond Truncate(Quaterniond q, double cosine, out bool truncated)
    {
        Quaterniond near = q.W >= 0 ? q : JointFrames.Negate(q);
        truncated = near.W < cosine;
        if (!truncated)
        {
            return near;
        }

        Vector3d v = near.Vector.Normalized() * Math.Sqrt(1 - cosine * cosine);
        return new Quaterniond(v.X, v.Y, v.Z, cosine);
    }

    private static Quaterniond AboutFreeAxis(Quaterniond q, Vector3d axis, double cosine, out bool truncated)
    {
        double a = Vector3d.Dot(q.Vector, axis);
        Quaterniond free = Math.Abs(a) >= 1e-6
            ? new Quaterniond(a * axis.X, a * axis.Y, a * axis.Z, q.W).Normalized()
            : Quaterniond.Identity;
        return Truncate(q * free.Conjugate(), cosine, out truncated) * free;
    }
}
