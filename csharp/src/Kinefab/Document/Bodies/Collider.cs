
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
}
