using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>SphereCollider.</summary>
public sealed class SphereCollider : Collider
{
    /// <summary>Local, metres.</summary>
    public Vector3d Center { get; init; }

    /// <summary>Metres, times the largest component of the world scale.</summary>
    public double Radius { get; init; } = 0.5;
}
