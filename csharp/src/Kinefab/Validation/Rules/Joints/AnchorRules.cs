using System;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>Whether the two anchors of a joint meet at start-up as its freedoms demand.</summary>
internal static class AnchorRules
{
    /// <summary>Misfit that rounding to float32 explains in a mechanism of some metres, metres.</summary>
    private const double Tolerance = 1e-4;

    /// <summary>Unity computes connectedAnchor itself while autoConfigureConnectedAnchor is on: another value in the file is lost.</summary>
    internal static void ConnectedAnchorRecomputed(AnchoredJoint joint, WorldTransform own, WorldTransform connected, in Place at)
    {
        if (joint.AutoConfigureConnectedAnchor && joint.ConnectedAnchor != Vector3d.Zero && JointAnchors.Gap(joint, own, connected).Length > Tolerance)
            at.Report("connectedAnchor", DiagnosticCodes.ConnectedAnchorRecomputed);
    }

    /// <summary>A hinge whose anchors stand apart is pulled together at the first step.</summary>
    internal static void Hinge(HingeJoint joint, WorldTransform own, WorldTransform connected, in Place at)
    {
        if (!joint.AutoConfigureConnectedAnchor)
            Apart(JointAnchors.Gap(joint, own, connected).Length, at);
    }

    /// <summary>As for a hinge, along the axes that are locked, and beyond the radius along those that are limited.</summary>
    internal static void Configurable(ConfigurableJoint joint, WorldTransform own, WorldTransform connected, in Place at)
    {
        if (joint.AutoConfigureConnectedAnchor)
            return;
        Vector3d along = JointAnchors.GapAlongAxes(joint, own, connected);
        double locked = Length(joint, along, ConfigurableJointMotion.Locked);
        double limited = Length(joint, along, ConfigurableJointMotion.Limited);
        Apart(Math.Max(locked, limited - joint.LinearLimit.Limit), at);
    }

    private static void Apart(double gap, in Place at)
    {
        if (gap > Tolerance)
            at.Report("connectedAnchor", DiagnosticCodes.JointAnchorsApart, ("gap", Invariant.Measured(gap)));
    }

    private static double Length(ConfigurableJoint joint, Vector3d along, ConfigurableJointMotion motion) => new Vector3d(
        joint.XMotion == motion ? along.X : 0,
        joint.YMotion == motion ? along.Y : 0,
        joint.ZMotion == motion ? along.Z : 0).Length;
}
