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

    /// <summary>Where a point of the GameObject's own axes is in the world, metres.</summary>
    internal Vector3d Point(Vector3d local) => Pose.Point(Vector3d.Scale(Scale, local));

    /// <summary>Of a child of this GameObject, from its local pose and scale.</summary>
    internal WorldTransform Child(Pose local, Vector3d scale) =>
        new(Pose * new Pose(Vector3d.Scale(Scale, local.Position), local.Rotation), Vector3d.Scale(Scale, scale));

    /// <summary>Pose in metres and degrees, and scale.</summary>
    public override string ToString() => $"{Pose}, scale {Scale}";
}
