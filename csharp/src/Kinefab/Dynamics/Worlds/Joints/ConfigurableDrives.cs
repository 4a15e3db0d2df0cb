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
                if (joint.Layout().IsSlerp)
                {
                    return ref joint.DriveSlerp;
                }

                if (axis == (int)CoordinateAxis.AngularX)
                {
                    return ref joint.DriveTwist;
                }

                if (axis == (int)CoordinateAxis.AngularY)
                {
                    return ref joint.DriveSwing1;
                }

                return ref joint.DriveSwing2;
        }
    }

    /// <summary>Goal of one component of c's position.</summary>
    public static void SetPosition(D6Joint joint, int axis, double goal)
    {
        Pose pose = joint.DrivePose;
        joint.DrivePose = new Pose(With(pose.Position, axis, goal), pose.Rotation);
    }

    /// <summary>The goals of c's angles about X, Y and Z that a joint has: 2 atan2(q_i, q_w) of its goal's rotation, radians.</summary>
    public static double[] Goals(D6Joint joint)
    {
        Quaterniond q = joint.DrivePose.Rotation;
        return new[] { 2 * Trigonometry.Atan2(q.X, q.W), 2 * Trigonometry.Atan2(q.Y, q.W), 2 * Trigonometry.Atan2(q.Z, q.W) };
    }

    /// <summary>
    /// Goals of c's angles, all at once: the one rotation of which each axis reads its own. About one axis alone it is the turn about
    /// it; else q_i / q_w = tan(goal_i / 2), with the denominators multiplied out so that half a turn has no pole.
    /// </summary>
    public static void SetAngles(D6Joint joint, ReadOnlySpan<double> goals)
    {
        int driven = -1;
        int count = 0;
        for (int i = 0; i < goals.Length; i++)
        {
            if (goals[i] != 0)
            {
                driven = i;
                count++;
            }
        }

        joint.DrivePose = new Pose(joint.DrivePose.Position, count <= 1
            ? Quaterniond.AxisAngle(With(Vector3d.Zero, Math.Max(driven, 0), 1), count == 0 ? 0 : goals[driven])
            : Together(goals));
    }

    private static Quaterniond Together(ReadOnlySpan<double> goals)
    {
        (double sx, double cx) = (Trigonometry.Sin(goals[0] / 2), Trigonometry.Cos(goals[0] / 2));
        (double sy, double cy) = (Trigonometry.Sin(goals[1] / 2), Trigonometry.Cos(goals[1] / 2));
        (double sz, double cz) = (Trigonometry.Sin(goals[2] / 2), Trigonometry.Cos(goals[2] / 2));
        return new Quaterniond(sx * cy * cz, cx * sy * cz, cx * cy * sz, cx * cy * cz).Normalized();
    }

    /// <summary>Goal of the rate of one component of c. Twist and swing drives want it the other way round.</summary>
    public static void SetSpeed(D6Joint joint, int axis, double rate)
    {
        if (axis < (int)CoordinateAxis.AngularX)
        {
            joint.DriveLinearVelocity = With(joint.DriveLinearVelocity, axis, rate);
            return;
        }

        double goal = joint.Layout().IsSlerp ? rate : -rate;
        joint.DriveAngularVelocity = With(joint.DriveAngularVelocity, axis - (int)CoordinateAxis.AngularX, goal);
    }

    private static Vector3d With(Vector3d v, int index, double value) =>
        new(index == 0 ? value : v.X, index == 1 ? value : v.Y, index == 2 ? value : v.Z);
}
