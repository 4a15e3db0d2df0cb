
namespace Kinefab.Document;

/// <summary>A collider; it belongs to the nearest Rigidbody on its own GameObject or an ancestor.</summary>
public abstract record Collider : Component
{
    private protected Collider()
    {
    }

    /// <summary>Reports contacts without stopping bodies.</summary>
    public bool IsTrigger { get; init; }

    /// <summary>Collider.enabled.</summary>
    public bool Enabled { get; init; } = true;

    /// <summary>Index into <see cref="SceneDocument.PhysicsMaterials"/>; null: Unity's default.</summary>
    [Since(1)]
    public int? Material { get; init; }

    /// <summary>The source's collision group or layer; null for none.</summary>
    [Since(1)]
    [Field(Shared = true)]
    public string? Group { get; init; }

    /// <summary>What the source calls it among the colliders of its object; null when it is not told.</summary>
    [Since(1)]
    public string? Id { get; init; }
}
