using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>SphereCollider.</summary>
public sealed partial record SphereCollider : Collider
{
    /// <summary>Local, metres.</summary>
    public Vector3d Center { get; init; }

    /// <summary>Metres, times the largest component of the world scale.</summary>
    public double Radius { get; init; } = 0.5;

    private protected override string Describe() => Line($"SphereCollider of radius {Radius} m at {Center} m{(IsTrigger ? ", trigger" : "")}");
}
