using System;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Mechanisms;

/// <summary>Where bodies and the frames of their joints stand in the file; the object that stands for the world, behind all others, at its origin.</summary>
internal sealed class LinkPoses
{
    // What a scale may differ from 1 by and be none.
    private const double Unscaled = 1e-9;

    // Below it a component of a direction or a rotation may be one of rounding, which decides nothing.
    private const double Alike = 1e-6;

    private readonly ValidScene scene;

    internal LinkPoses(ValidScene scene) => this.scene = scene;

    /// <summary>Of an object in the world.</summary>
    internal Pose this[int gameObject] => At(gameObject).Pose;

    /// <summary>A link stands below others, whose scale would be its own.</summary>
    internal string? WhyScaled(int child, int? parent) => IsScaled(child) || (parent is int above && IsScaled(above)) ? "its bodies are scaled" : null;

    /// <summary>How far a slide stands out at the exported pose, where its anchors meet being zero; metres.</summary>
    internal double Start(Joint joint, int own, int other) =>
        joint is AnchoredJoint { AutoConfigureConnectedAnchor: false } anchored
            ? Vector3d.Dot(JointAnchors.Gap(anchored, At(own), At(other)), UnityFrames.Own(joint, At(own)).Rotation * Vector3d.UnitX)
            : 0;

    /// <summary>The joint's frame where the exported pose has it, in the world; X so that the link's motion is the own body's.</summary>
    internal Pose Frame(Joint joint, int own, int other, int child, bool onChild)
    {
        if (joint is not AnchoredJoint anchored)
            return this[child];
        Pose frame = UnityFrames.Own(joint, At(own));
        Vector3d point = onChild || anchored.AutoConfigureConnectedAnchor ? frame.Position : At(other).Point(anchored.ConnectedAnchor);
        Vector3d x = frame.Rotation * Vector3d.UnitX;
        Vector3d second = joint is ConfigurableJoint ? frame.Rotation * Vector3d.UnitY : this[own].Rotation * Across(anchored.Axis.Normalized());
        x = onChild ? x : -x;
        Vector3d z = Vector3d.Cross(x, second).Normalized();
        return new Pose(point, Quaterniond.FromAxes(x, Vector3d.Cross(z, x), z));
    }

    /// <summary>A place in the hierarchy.</summary>
    internal static Transform Place(Pose pose) => new() { LocalPosition = pose.Position, LocalRotation = Upright(pose.Rotation) };

    /// <summary>The same rotation, w not negative; about half a turn, where that hangs on rounding, the first of x, y, z that is not 0 positive.</summary>
    internal static Quaterniond Upright(Quaterniond turn)
    {
        double first = 1;
        foreach (double each in new[] { turn.W, turn.Z, turn.Y, turn.X })
            first = Math.Abs(each) > Alike ? each : first;
        return (Math.Abs(turn.W) > Alike ? turn.W : first) > 0 ? turn : new Quaterniond(-turn.X, -turn.Y, -turn.Z, -turn.W);
    }

    private bool IsScaled(int gameObject)
    {
        Vector3d scale = At(gameObject).Scale;
        return Math.Abs(scale.X - 1) > Unscaled || Math.Abs(scale.Y - 1) > Unscaled || Math.Abs(scale.Z - 1) > Unscaled;
    }

    private WorldTransform At(int gameObject) =>
        gameObject < scene.Document.GameObjects.Count ? scene.WorldTransform(gameObject) : new WorldTransform(Pose.Identity, new Vector3d(1, 1, 1));

    // Some direction at right angles to an axis, which a hinge does not say; the exporter's, for equal files.
    private static Vector3d Across(Vector3d axis)
    {
        int smallest = 0;
        for (int i = 1; i < 3; i++)
            smallest = Math.Abs(axis[i]) < Math.Abs(axis[smallest]) - Alike ? i : smallest;
        return Vector3d.Cross(axis == Vector3d.Zero ? Vector3d.UnitX : axis, smallest == 0 ? Vector3d.UnitX : smallest == 1 ? Vector3d.UnitY : Vector3d.UnitZ);
    }
}
