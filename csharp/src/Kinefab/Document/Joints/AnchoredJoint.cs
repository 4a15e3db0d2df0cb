using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>A joint with an anchor and an axis on each body.</summary>
public abstract record AnchoredJoint : Joint
{
    private protected AnchoredJoint()
    {
    }

    /// <summary>Own local space, metres, multiplied by the GameObject's world scale.</summary>
    public Vector3d Anchor { get; init; }

    /// <summary>Own local direction of the joint's X, of any length.</summary>
    public Vector3d Axis { get; init; } = Vector3d.UnitX;

    /// <summary>When true, Unity computes <see cref="ConnectedAnchor"/> from <see cref="Anchor"/> at start-up.</summary>
    public bool AutoConfigureConnectedAnchor { get; init; } = true;

    /// <summary>Connected body's local space (scaled), or the world's when there is none; metres.</summary>
    public Vector3d ConnectedAnchor { get; init; }

    /// <summary>Largest force of whatever drives a coordinate that moves, N or N m; infinite: not stated. Neither solver follows it.</summary>
    [Since(1)]
    public double Effort { get; init; } = double.PositiveInfinity;

    /// <summary>Largest rate of a coordinate that moves, m/s or degrees/s; infinite: not stated. Neither solver follows it.</summary>
    [Since(1)]
    public double Speed { get; init; } = double.PositiveInfinity;

    /// <summary>Largest dry friction of a coordinate that moves, N or N m. Neither solver follows it.</summary>
    [Since(1)]
    public double Friction { get; init; }

    /// <summary>Inertia that moves with a coordinate, kg or kg m^2. Neither solver follows it.</summary>
    [Since(1)]
    public double Armature { get; init; }

    /// <summary>What the source states of one coordinate that moves.</summary>
    internal virtual StatedAxis StatedOf(Coordinate coordinate) => new() { Effort = Effort, Speed = Speed, Friction = Friction, Armature = Armature };
}
