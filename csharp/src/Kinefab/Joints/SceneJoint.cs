using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Joints;

/// <summary>Makes a joint component's joint as Unity does when the scene starts.</summary>
internal static class SceneJoint
{
    /// <summary>The joint with its bodies and frames.</summary>
    /// <param name="scene">At its start-up poses.</param>
    /// <param name="gameObject">The object that carries the component.</param>
    /// <param name="settings">The component.</param>
    /// <param name="own">The body it stands on.</param>
    /// <param name="ownStart">That body's frame in the world.</param>
    /// <param name="connected">The connected body, or Joint.World.</param>
    /// <param name="connectedStart">That body's frame in the world; the identity for the world.</param>
    public static Joint Make(ValidScene scene, int gameObject, Document.Joint settings, int own, in Pose ownStart, int connected, in Pose connectedStart)
    {
        WorldTransform? other = settings.ConnectedBody is int index ? scene.WorldTransform(index) : null;
        Pose world = UnityFrames.Own(settings, scene.WorldTransform(gameObject));
        Pose ownFrame = ownStart.Inverse() * world;
        Pose connectedFrame = connectedStart.Inverse() * UnityFrames.Connected(settings, world, other);
        bool swap = settings is ConfigurableJoint { SwapBodies: true };
        Joint joint = UnityJoints.Create(settings);
        joint.Body0 = swap ? connected : own;
        joint.Body1 = swap ? own : connected;
        joint.Frame0 = swap ? connectedFrame : ownFrame;
        joint.Frame1 = swap ? ownFrame : connectedFrame;
        return joint;
    }
}
