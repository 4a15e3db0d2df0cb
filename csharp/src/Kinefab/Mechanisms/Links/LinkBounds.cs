using System;
using System.Collections.Generic;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;

namespace Kinefab.Mechanisms;

/// <summary>What a link's drives and joint are bounded by beside their limits: largest effort, largest speed, dry friction.</summary>
internal static class LinkBounds
{
    private const double Radians = Math.PI / 180;

    // m/s or rad/s of a link's axis where nobody states less: PhysX's own maxJointVelocity.
    private const double Fastest = 100;

    /// <summary>The link with them, told where it holds one otherwise or not.</summary>
    internal static ArticulationBody Set(ArticulationBody link, AnchoredJoint joint, string name, string pointer, ToldLosses told, List<Diagnostic> findings)
    {
        bool slides = link.JointType == ArticulationJointType.Prismatic;
        if (link.JointType == ArticulationJointType.Revolute)
            told.IsKept($"stop of joint {name}", "JOINT_STOP_WRAPS"); // PhysX holds a link's range within a whole turn to either side
        double speed = slides ? joint.Speed : joint.Speed * Radians;
        bool hasSpeed = speed > 0 && speed < double.PositiveInfinity;
        if (hasSpeed)
            link = link with { MaxJointVelocity = speed };
        if (joint.Effort < double.PositiveInfinity)
        {
            double most = hasSpeed ? Math.Min(speed, Fastest) : Fastest;
            bool isHeld = true, isActuated = joint is ConfigurableJoint { RotationDriveMode: RotationDriveMode.Slerp };
            ArticulationDrive Bound(ArticulationDrive drive, bool acts, ConfigurableJointMotion motion)
            {
                if (!acts)
                    return drive;
                bool isOwn = !isActuated && MayBeOwn(drive, motion == ConfigurableJointMotion.Limited, slides ? 1 : Radians, most, joint.Effort);
                isHeld &= !isOwn;
                return isOwn ? drive : drive with { ForceLimit = Math.Min(drive.ForceLimit, joint.Effort) };
            }

            bool isBall = link.JointType == ArticulationJointType.Spherical;
            link = link with
            {
                XDrive = Bound(link.XDrive, !isBall || link.TwistLock != ConfigurableJointMotion.Locked, slides ? link.LinearLock : link.TwistLock),
                YDrive = Bound(link.YDrive, isBall && link.SwingYLock != ConfigurableJointMotion.Locked, link.SwingYLock),
                ZDrive = Bound(link.ZDrive, isBall && link.SwingZLock != ConfigurableJointMotion.Locked, link.SwingZLock),
            };
            if (!isHeld)
                findings.Add(Diagnostic.Of(DiagnosticCodes.JointEffortDropped, pointer, ("joint", name), ("limits", $"effort ({Invariant.Text(joint.Effort)})"), ("freedom", "its coordinate")));
        }

        if (joint.Friction > 0)
            findings.Add(Diagnostic.Of(DiagnosticCodes.JointFrictionCoefficient, pointer, ("joint", name), ("value", Invariant.Text(joint.Friction))));
        if (joint.Armature > 0)
            findings.Add(Diagnostic.Of(DiagnosticCodes.JointArmatureDropped, pointer, ("joint", name), ("freedom", "its coordinate"), ("value", Invariant.Text(joint.Armature))));
        return link with { JointFriction = joint.Friction };
    }

    // A joint's own spring and damper are in its one drive too, and no effort bounds those. The exporter gives such a drive no largest force; the file does not tell it from an
    // actuator's without one, so what could come to more than the effort is left as it is.
    private static bool MayBeOwn(ArticulationDrive drive, bool isLimited, double unit, double speed, double effort)
    {
        if (drive.ForceLimit < double.PositiveInfinity || drive.DriveType != ArticulationDriveType.Force)
            return false;
        double most = drive.Damping * speed;
        if (drive.Stiffness > 0)
            most += isLimited ? drive.Stiffness * unit * Math.Max(Math.Abs(drive.LowerLimit - drive.Target), Math.Abs(drive.UpperLimit - drive.Target)) : double.PositiveInfinity;
        return most > effort;
    }
}
