using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>Transform, local to the parent.</summary>
public sealed partial record Transform : DocumentObject
{
    /// <summary>At the parent's origin, unturned, unscaled.</summary>
    public static Transform Default { get; } = new();

    /// <summary>Metres, in the parent's frame.</summary>
    public Vector3d LocalPosition { get; init; }

    /// <summary>Parent's frame from own frame.</summary>
    public Quaterniond LocalRotation { get; init; } = Quaterniond.Identity;

    /// <summary>Along the own axes.</summary>
    public Vector3d LocalScale { get; init; } = new(1, 1, 1);

    private protected override string Describe() => Line($"at {LocalPosition} m, rotation {LocalRotation}, scale {LocalScale}");
}
