using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>A collider; it belongs to the nearest Rigidbody on its own GameObject or an ancestor.</summary>
public abstract record Collider : Component
{
    private protected static readonly string[] ColliderFields = ["isTrigger", "enabled"];

    private bool isTrigger;
    private bool enabled = true;

    private protected Collider()
    {
    }

    /// <summary>Reports contacts without stopping bodies.</summary>
    public bool IsTrigger
    {
        get => isTrigger;
        init => isTrigger = value;
    }

    /// <summary>Collider.enabled.</summary>
    public bool Enabled
    {
        get => enabled;
        init => enabled = value;
    }

    private protected void ReadColliderField(ref JsonCursor json, string field)
    {
        switch (field)
        {
            case "isTrigger":
                isTrigger = json.Boolean();
                break;
            case "enabled":
                enabled = json.Boolean();
                break;
        }
    }
}
