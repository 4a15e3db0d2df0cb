using System.Diagnostics;
using System;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>Where a GameObject stands in the world.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public readonly struct WorldTransform
{
    /// <summary>From parts.</summary>
    /// <param name="pose">Of the GameObject in the world, Unity's frame, metres.</param>
    /// <param name="scale">Along its own axes, without unit.</param>
    public WorldTransform(Pose pose, Vector3d scale)
    {
        Pose = pose;
        Scale = scale;
    }

    /// <summary>World frame from own frame.</summary>
    public Pose Pose { get; }

    /// <summary>Along the own axes: Unity's lossyScale, exact unless a turned object hangs under an unevenly scaled one.</summary>
    public Vector3d Scale { get; }

    /// <summary>Of all GameObjects; a parent must stand before its children.</summary>
    internal static WorldTransform[] Of(SceneDocument document)
    {
        ReadOnlySpan<GameObject> objects = document.GameObjectSpan;
        var world = new WorldTransform[objects.Length];
        for (int i = 0; i < world.Length; i++)
        {
            Transform local = objects[i].Transform;
            var pose = new Pose(local.LocalPosition, local.LocalRotation.Normalized());
            world[i] = objects[i].Parent is int parent
                ? world[parent].Child(pose, local.LocalScale)
                : new WorldTransform(pose, local.LocalScale);
        }

        return world;
    }

    private WorldTransform Child(Pose local, Vector3d scale) =>
        new(Pose * new Pose(Vector3d.Scale(Scale, local.Position), local.Rotation), Vector3d.Scale(Scale, scale));

    /// <summary>Pose in metres and degrees, and scale.</summary>
    public override string ToString() => $"{Pose}, scale {Scale}";
}
