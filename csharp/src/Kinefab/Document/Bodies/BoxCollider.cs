using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>BoxCollider.</summary>
public sealed partial record BoxCollider : Collider
{
    /// <summary>Local, metres.</summary>
    public Vector3d Center { get; init; }

    /// <summary>Full size, local, metres.</summary>
    public Vector3d Size { get; init; } = new(1, 1, 1);

    private protected override string Describe() => Line($"BoxCollider {Size} m at {Center} m{(IsTrigger ? ", trigger" : "")}");
}
