using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>Where the two anchors of a joint stand at start-up.</summary>
internal static class JointAnchors
{
    /// <summary>From the connected anchor to the own one, world, metres.</summary>
    internal static Vector3d Gap(AnchoredJoint joint, WorldTransform own, WorldTransform connected) =>
        own.Point(joint.Anchor)
        - connected.Point(joint.ConnectedAnchor);

    /// <summary>The same along the joint's X, Y and Z; zero where Unity works the connected anchor out.</summary>
    internal static Vector3d StartGap(ConfigurableJoint joint, WorldTransform own, WorldTransform connected) =>
        joint.AutoConfigureConnectedAnchor ? Vector3d.Zero : GapAlongAxes(joint, own, connected);

    /// <summary>The same along the joint's X, Y and Z, whoever works the connected anchor out.</summary>
    internal static Vector3d GapAlongAxes(ConfigurableJoint joint, WorldTransform own, WorldTransform connected)
    {
        Vector3d gap = Gap(joint, own, connected);
        Quaterniond frame = joint.ConfiguredInWorldSpace ? Quaterniond.Identity : own.Pose.Rotation;
        Vector3d x = joint.Axis.Normalized();
        Vector3d y = (joint.SecondaryAxis - Vector3d.Dot(joint.SecondaryAxis, x) * x).Normalized();
        Vector3d local = frame.InverseRotate(gap);
        return new Vector3d(Vector3d.Dot(local, x), Vector3d.Dot(local, y), Vector3d.Dot(local, Vector3d.Cross(x, y)));
    }
}
