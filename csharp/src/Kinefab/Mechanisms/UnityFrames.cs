using System;
using Kinefab.Document;
using Kinefab.Joints;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Mechanisms;

/// <summary>Where Unity puts a joint's two frames when it creates the joint. World frames; z = x cross y by components.</summary>
internal static class UnityFrames
{
    /// <summary>The own frame in the world at start-up.</summary>
    /// <param name="joint">Its axis and anchor; a FixedJoint stands at its object's origin.</param>
    /// <param name="own">Start pose and scale of the object that carries the joint.</param>
    public static Pose Own(Document.Joint joint, in WorldTransform own)
    {
        if (joint is not AnchoredJoint anchored)
        {
            return own.Pose;
        }

        Vector3d secondary = joint is ConfigurableJoint configurable ? configurable.SecondaryAxis : Vector3d.Zero;
        Quaterniond axes = Axes(anchored.Axis, secondary);
        bool inWorld = joint is ConfigurableJoint { ConfiguredInWorldSpace: true };
        return new Pose(
            own.Point(anchored.Anchor),
            inWorld ? axes : own.Pose.Rotation * axes);
    }

    /// <summary>The connected frame in the world at start-up: the own frame's rotation, so that every angle starts at 0.</summary>
    /// <param name="joint">Its connected anchor, used unless Unity computes it from the own anchor.</param>
    /// <param name="ownFrame">What <see cref="Own"/> gave.</param>
    /// <param name="connected">Start pose and scale of the connected object; null for the world.</param>
    public static Pose Connected(Document.Joint joint, in Pose ownFrame, WorldTransform? connected)
    {
        if (joint is not AnchoredJoint { AutoConfigureConnectedAnchor: false } anchored)
        {
            return ownFrame;
        }

        Vector3d anchor = connected is WorldTransform body
            ? body.Point(anchored.ConnectedAnchor)
            : anchored.ConnectedAnchor;
        return new Pose(anchor, ownFrame.Rotation);
    }

    /// <summary>
    /// x = axis, y = secondary less its part along x (Gram-Schmidt), z = x cross y: Unity takes its axes neither as of unit
    /// length nor as at right angles. A zero axis stands for the field's default, (1, 0, 0); a secondary axis that is zero or
    /// along the axis for <see cref="Vector3d.Perpendicular"/>, as a HingeJoint has it: both frames start as one, so its angle starts at 0.
    /// </summary>
    public static Quaterniond Axes(Vector3d axis, Vector3d secondary)
    {
        const double parallel = 1e-6;
        Vector3d x = axis.Normalized();
        if (x == Vector3d.Zero)
        {
            x = Vector3d.UnitX;
        }

        Vector3d s = secondary.Normalized();
        Vector3d y = s - x * Vector3d.Dot(x, s);
        y = y.Length > parallel ? y.Normalized() : Vector3d.Perpendicular(x);
        return Quaterniond.FromAxes(x, y, Vector3d.Cross(x, y));
    }
}
