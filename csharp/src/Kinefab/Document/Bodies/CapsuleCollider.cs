using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>CapsuleCollider.</summary>
public sealed partial record CapsuleCollider : Collider
{
    /// <summary>Local, metres.</summary>
    public Vector3d Center { get; init; }

    /// <summary>Metres.</summary>
    public double Radius { get; init; } = 0.5;

    /// <summary>With both caps, metres.</summary>
    public double Height { get; init; } = 1;

    /// <summary>The local axis that the capsule lies along.</summary>
    public Axis Direction { get; init; } = Axis.Y;

    private protected override string Describe() => Line($"CapsuleCollider of radius {Radius} m and height {Height} m along {Direction} at {Center} m{(IsTrigger ? ", trigger" : "")}");
}
