using System;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>ArticulationBodies.</summary>
internal static class LinkRules
{
    internal static void Numbers(ArticulationBody link, in Place at)
    {
        BodyRules.Numbers(link.AsRigidbody, at);
        NumberRules.Finite(at, "parentAnchorPosition", link.ParentAnchorPosition);
        NumberRules.Unit(at, "parentAnchorRotation", link.ParentAnchorRotation);
        NumberRules.Finite(at, "anchorPosition", link.AnchorPosition);
        NumberRules.Unit(at, "anchorRotation", link.AnchorRotation);
        NumberRules.NotNegative(at, "jointFriction", link.JointFriction);
        if (link.MaxJointVelocity is double speed)
            NumberRules.Positive(at, "maxJointVelocity", speed);
        Drive(link.XDrive, "xDrive", at);
        Drive(link.YDrive, "yDrive", at);
        Drive(link.ZDrive, "zDrive", at);
    }

    internal static void Mass(ArticulationBody link, in Place at)
    {
        BodyRules.Mass(link.AsRigidbody, at);
        BodyRules.Inertia(link.AsRigidbody, at);
    }

    /// <summary>Only limits that count.</summary>
    internal static void LimitsOrder(ArticulationBody link, in Place at)
    {
        for (int axis = 0; axis < 3; axis++)
        {
            ArticulationDrive drive = Of(link, axis);
            if (Motion(link, axis) == ConfigurableJointMotion.Limited && drive.LowerLimit > drive.UpperLimit)
                at.Report(Name(axis) + "/lowerLimit", DiagnosticCodes.LinkLimitsOrder, ("lower", Invariant.Text(drive.LowerLimit)), ("upper", Invariant.Text(drive.UpperLimit)));
        }
    }

    internal static void LockedDrives(ArticulationBody link, in Place at)
    {
        for (int axis = 0; axis < 3; axis++)
        {
            if (Of(link, axis).IsActive && Motion(link, axis) == ConfigurableJointMotion.Locked)
                at.Report(Name(axis), DiagnosticCodes.DriveOnLockedFreedom);
        }
    }

    /// <summary>One limited axis of a spherical joint alone.</summary>
    internal static void SphericalLocks(ArticulationBody link, in Place at)
    {
        if (link.JointType != ArticulationJointType.Spherical)
            return;
        int limited = 0;
        for (int axis = 0; axis < 3; axis++)
            limited += Motion(link, axis) == ConfigurableJointMotion.Limited ? 1 : 0;
        if (limited == 1)
            at.Report("jointType", DiagnosticCodes.LinkSphericalOneLimited);
    }

    /// <summary>What stands above and beside the link.</summary>
    internal static void Tree(SceneDocument document, HierarchyPlaces places, int gameObject, in Place at)
    {
        ReadOnlySpan<GameObject> objects = document.GameObjectSpan;
        ArticulationBody link = objects[gameObject].Link!;
        bool hasRigidbody = false;
        foreach (Component component in objects[gameObject].ComponentSpan)
            hasRigidbody |= component is Rigidbody;
        if (hasRigidbody)
            at.Report("", DiagnosticCodes.LinkAndRigidbody);
        if (link.Immovable && places.LinkAbove(gameObject) is not null)
            at.Report("immovable", DiagnosticCodes.LinkImmovableNotRoot);
        if (objects[gameObject].Parent is int parent && (uint)parent < (uint)gameObject && places.BodyOf(parent) is int above && objects[above].Link is null)
            at.Report("", DiagnosticCodes.LinkBelowRigidbody, ("object", objects[above].Id));
    }

    /// <summary>The two anchors of a joint are one frame at the start; else the first step snaps the link there.</summary>
    internal static void Anchors(ArticulationBody link, WorldTransform own, WorldTransform above, in Place at)
    {
        double gap = (own.Point(link.AnchorPosition) - above.Point(link.ParentAnchorPosition)).Length;
        Quaterniond turn = (own.Pose.Rotation * link.AnchorRotation.Normalized()).Conjugate() * (above.Pose.Rotation * link.ParentAnchorRotation.Normalized());
        double angle = 2 * Trigonometry.Atan2(turn.Vector.Length, Math.Abs(turn.W)) * 180 / Math.PI;
        if (gap > LeastGap || angle > LeastAngle)
            at.Report("parentAnchorPosition", DiagnosticCodes.LinkAnchorsApart, ("distance", Invariant.Measured(gap)), ("angle", Invariant.Measured(angle)));
    }

    // Metres and degrees; numbers of a file are rounded.
    private const double LeastGap = 1e-4;
    private const double LeastAngle = 0.01;

    private static void Drive(ArticulationDrive drive, string name, in Place at)
    {
        if (ReferenceEquals(drive, ArticulationDrive.Default))
            return;
        NumberRules.Finite(at, name + "/lowerLimit", drive.LowerLimit);
        NumberRules.Finite(at, name + "/upperLimit", drive.UpperLimit);
        NumberRules.NotNegative(at, name + "/stiffness", drive.Stiffness);
        NumberRules.NotNegative(at, name + "/damping", drive.Damping);
        NumberRules.NotNegativeOrUnlimited(at, name + "/forceLimit", drive.ForceLimit);
        NumberRules.Finite(at, name + "/target", drive.Target);
        NumberRules.Finite(at, name + "/targetVelocity", drive.TargetVelocity);
    }

    private static ConfigurableJointMotion Motion(ArticulationBody link, int axis) =>
        link.JointType == ArticulationJointType.Prismatic && axis == 0 ? LinkJoint.SlideMotion(link) : LinkJoint.TurnMotion(link, axis);

    private static ArticulationDrive Of(ArticulationBody link, int axis) => axis == 0 ? link.XDrive : axis == 1 ? link.YDrive : link.ZDrive;

    private static string Name(int axis) => axis == 0 ? "xDrive" : axis == 1 ? "yDrive" : "zDrive";
}
