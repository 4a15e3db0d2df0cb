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
        if (link.JointType == ArticulationJointType.Revolute)
            told.IsKept($"stop of joint {name}", "JOINT_STOP_WRAPS"); // PhysX holds a link's range within a whole turn to either side
        List<Coordinate> axes = Axes(link, joint);
        double? speed = Speed(link, joint, axes);
        double friction = 0;
        foreach (Coordinate axis in axes)
        {
            StatedAxis stated = joint.StatedOf(axis);
            friction = Math.Max(friction, stated.Friction);
            bool isOwn = JointExtras.IsOwn(joint, CoordinateWords.Table.WordOf(axis));
            if (stated.Effort < double.PositiveInfinity && !isOwn)
                link = Bounded(link, axis, stated.Effort);
            var lost = new List<string>();
            if (stated.Effort < double.PositiveInfinity && isOwn)
                lost.Add($"effort ({Invariant.Text(stated.Effort)})");
            if (stated.Speed < double.PositiveInfinity && speed is null)
                lost.Add($"speed ({Invariant.Text(stated.Speed)})");
            if (lost.Count > 0)
                findings.Add(Diagnostic.Of(DiagnosticCodes.JointEffortDropped, pointer, ("joint", name), ("limits", string.Join(" and ", lost)), ("freedom", CoordinateWords.Table.WordOf(axis))));
            if (stated.Armature > 0)
                findings.Add(Diagnostic.Of(DiagnosticCodes.JointArmatureDropped, pointer, ("joint", name), ("freedom", CoordinateWords.Table.WordOf(axis)), ("value", Invariant.Text(stated.Armature))));
        }

        if (friction > 0)
            findings.Add(Diagnostic.Of(DiagnosticCodes.JointFrictionCoefficient, pointer, ("joint", name), ("value", Invariant.Text(friction))));
        return link with { MaxJointVelocity = speed ?? link.MaxJointVelocity, JointFriction = friction };
    }

    // Those that move.
    private static List<Coordinate> Axes(ArticulationBody link, AnchoredJoint joint)
    {
        var axes = new List<Coordinate>();
        if (link.JointType != ArticulationJointType.Spherical || link.TwistLock != ConfigurableJointMotion.Locked)
            axes.Add(joint is HingeJoint ? Coordinate.Angle : link.JointType == ArticulationJointType.Prismatic ? Coordinate.X : Coordinate.AngularX);
        if (link.JointType != ArticulationJointType.Spherical)
            return axes;
        if (link.SwingYLock != ConfigurableJointMotion.Locked)
            axes.Add(Coordinate.AngularY);
        if (link.SwingZLock != ConfigurableJointMotion.Locked)
            axes.Add(Coordinate.AngularZ);
        return axes;
    }

    // m/s or rad/s. A link has one for all its axes; with 0 it would stand still for ever, and what that means the source does not say.
    private static double? Speed(ArticulationBody link, AnchoredJoint joint, List<Coordinate> axes)
    {
        double speed = joint.StatedOf(axes[0]).Speed;
        bool isOne = axes.TrueForAll(axis => joint.StatedOf(axis).Speed == speed);
        return isOne && speed > 0 && speed < double.PositiveInfinity ? (link.JointType == ArticulationJointType.Prismatic ? speed : speed * Radians) : null;
    }

    private static ArticulationBody Bounded(ArticulationBody link, Coordinate axis, double effort)
    {
        ArticulationDrive Least(ArticulationDrive drive) => drive with { ForceLimit = Math.Min(drive.ForceLimit, effort) };
        return axis switch
        {
            Coordinate.AngularY => link with { YDrive = Least(link.YDrive) },
            Coordinate.AngularZ => link with { ZDrive = Least(link.ZDrive) },
            _ => link with { XDrive = Least(link.XDrive) },
        };
    }
}
