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
            bool isHeld = true, isHinge = joint is HingeJoint;
            ArticulationDrive Bound(ArticulationDrive drive, bool acts, string coordinate)
            {
                if (!acts)
                    return drive;
                bool isOwn = JointExtras.IsOwn(joint, coordinate);
                isHeld &= !isOwn;
                return isOwn ? drive : drive with { ForceLimit = Math.Min(drive.ForceLimit, joint.Effort) };
            }

            bool isBall = link.JointType == ArticulationJointType.Spherical;
            link = link with
            {
                XDrive = Bound(link.XDrive, !isBall || link.TwistLock != ConfigurableJointMotion.Locked, slides ? "x" : isHinge ? "angle" : "angularX"),
                YDrive = Bound(link.YDrive, isBall && link.SwingYLock != ConfigurableJointMotion.Locked, "angularY"),
                ZDrive = Bound(link.ZDrive, isBall && link.SwingZLock != ConfigurableJointMotion.Locked, "angularZ"),
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
}
