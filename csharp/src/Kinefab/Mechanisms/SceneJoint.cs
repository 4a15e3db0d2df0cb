using Kinefab.Document;
using Kinefab.Joints;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Mechanisms;

/// <summary>Makes a joint component's joint as Unity does when the scene starts.</summary>
internal static class SceneJoint
{
    /// <summary>The joint with its bodies and frames.</summary>
    /// <param name="scene">At its start-up poses.</param>
    /// <param name="definition">The component and the bodies at its ends.</param>
    /// <param name="starts">For each body its frame in the world at start-up.</param>
    public static Kinefab.Joints.JointModel Make(ValidScene scene, in JointDefinition definition, Pose[] starts)
    {
        Document.Joint settings = definition.Source;
        WorldTransform? other = settings.ConnectedBody is int index ? scene.WorldTransform(index) : null;
        Pose world = UnityFrames.Own(settings, scene.WorldTransform(definition.GameObject));
        Pose ownFrame = Start(definition.Own, starts).Inverse() * world;
        Pose connectedFrame = Start(definition.Connected, starts).Inverse() * UnityFrames.Connected(settings, world, other);
        bool swap = settings is ConfigurableJoint { SwapBodies: true };
        Kinefab.Joints.JointModel joint = UnityJoints.Create(settings);
        joint.Body0 = swap ? definition.Connected : definition.Own;
        joint.Body1 = swap ? definition.Own : definition.Connected;
        joint.Frame0 = swap ? connectedFrame : ownFrame;
        joint.Frame1 = swap ? ownFrame : connectedFrame;
        return joint;
    }

    private static Pose Start(int body, Pose[] starts) => body < 0 ? Pose.Identity : starts[body];
}
