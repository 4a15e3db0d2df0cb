using System;
using Kinefab.Document;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>Joints as position-level kinematics needs them: without drives, with limits that are hard and seen from afar.</summary>
internal static class PositionJoint
{
    // The cone's error has no direction at its centre, so it is looked at from this close only, radians.
    private const double ConeContactDistance = 1e-3;

    /// <summary>Strips a joint, which must be the caller's own, of all that is not geometry.</summary>
    public static JointModel From(JointModel joint)
    {
        var far = new LimitResponse { ContactDistance = double.PositiveInfinity };
        switch (joint)
        {
            case RevoluteJoint hinge:
                hinge.MotorEnabled = false;
                hinge.Spring = default;
                hinge.Limit.Response = far;
                break;
            case D6Joint d6:
                d6.DriveX = d6.DriveY = d6.DriveZ = d6.DriveTwist = d6.DriveSwing = d6.DriveSlerp = default;
                d6.LinearLimit.Response = far;
                d6.TwistLimit.Response = far;
                bool isCone = d6.Swing1 == AxisMotion.Limited && d6.Swing2 == AxisMotion.Limited;
                d6.SwingLimit.Response = isCone ? new LimitResponse { ContactDistance = ConeContactDistance } : far;
                break;
        }

        return joint;
    }

    /// <summary>The joint to the world that a Rigidbody's frozen motions amount to; null when there are none.</summary>
    public static JointModel? Freeze(int body, in Pose start, RigidbodyConstraints frozen)
    {
        if (frozen == RigidbodyConstraints.None)
        {
            return null;
        }

        return new D6Joint
        {
            Body0 = JointModel.World,
            Body1 = body,
            Frame0 = new Pose(start.Position, Quaterniond.Identity),
            Frame1 = new Pose(Vector3d.Zero, start.Rotation.Conjugate()),
            X = Motion(frozen, RigidbodyConstraints.FreezePositionX),
            Y = Motion(frozen, RigidbodyConstraints.FreezePositionY),
            Z = Motion(frozen, RigidbodyConstraints.FreezePositionZ),
            Twist = Motion(frozen, RigidbodyConstraints.FreezeRotationX),
            Swing1 = Motion(frozen, RigidbodyConstraints.FreezeRotationY),
            Swing2 = Motion(frozen, RigidbodyConstraints.FreezeRotationZ),
        };
    }

    private static AxisMotion Motion(RigidbodyConstraints frozen, RigidbodyConstraints axis) =>
        (frozen & axis) != 0 ? AxisMotion.Locked : AxisMotion.Free;
}
