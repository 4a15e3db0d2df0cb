using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics;

/// <summary>The drive of a D6 that acts on one axis, and its goal. Axes as in <see cref="CoordinateAxis"/>, all of c: actor 1 in actor 0.</summary>
internal static class ConfigurableDrives
{
    /// <summary>The drive in use; about an angle the slerp drive where it is active, since it replaces the others.</summary>
    public static ref DriveModel Of(D6Joint joint, int axis)
    {
        switch ((CoordinateAxis)axis)
        {
            case CoordinateAxis.X:
                return ref joint.DriveX;
            case CoordinateAxis.Y:
                return ref joint.DriveY;
            case CoordinateAxis.Z:
                return ref joint.DriveZ;
            default:
                if (IsSlerp(joint))
                {
                    return ref joint.DriveSlerp;
                }

                if (axis == (int)CoordinateAxis.AngularX)
                {
                    return ref joint.DriveTwist;
                }

                return ref joint.DriveSwing;
        }
    }

    /// <summary>Goal of one component of c's position, or of c's rotation as a turn about that axis alone.</summary>
    public static void SetTarget(D6Joint joint, int axis, double goal)
    {
        Pose pose = joint.DrivePose;
        joint.DrivePose = axis < (int)CoordinateAxis.AngularX
            ? new Pose(With(pose.Position, axis, goal), pose.Rotation)
            : new Pose(pose.Position, Quaterniond.AxisAngle(With(Vector3d.Zero, axis - (int)CoordinateAxis.AngularX, 1), goal));
    }

    /// <summary>Goal of the rate of one component of c. Twist and swing drives want it the other way round.</summary>
    public static void SetSpeed(D6Joint joint, int axis, double rate)
    {
        if (axis < (int)CoordinateAxis.AngularX)
        {
            joint.DriveLinearVelocity = With(joint.DriveLinearVelocity, axis, rate);
            return;
        }

        double goal = IsSlerp(joint) ? rate : -rate;
        joint.DriveAngularVelocity = With(joint.DriveAngularVelocity, axis - (int)CoordinateAxis.AngularX, goal);
    }

    private static bool IsSlerp(D6Joint joint) =>
        joint.DriveSlerp.IsActive && joint.Twist != AxisMotion.Locked && joint.Swing1 != AxisMotion.Locked && joint.Swing2 != AxisMotion.Locked;

    private static Vector3d With(Vector3d v, int index, double value) =>
        new(index == 0 ? value : v.X, index == 1 ? value : v.Y, index == 2 ? value : v.Z);
}
