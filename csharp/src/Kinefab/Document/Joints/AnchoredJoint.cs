using Kinefab.Numerics;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>A joint with an anchor and an axis on each body.</summary>
public abstract record AnchoredJoint : Joint
{
    private protected static readonly string[] AnchoredJointFields =
        [.. JointFields, "anchor", "axis", "autoConfigureConnectedAnchor", "connectedAnchor"];

    private Vector3d anchor;
    private Vector3d axis = Vector3d.UnitX;
    private bool autoConfigureConnectedAnchor = true;
    private Vector3d connectedAnchor;

    private protected AnchoredJoint()
    {
    }

    /// <summary>Own local space, metres, multiplied by the GameObject's world scale.</summary>
    public Vector3d Anchor
    {
        get => anchor;
        init => anchor = value;
    }

    /// <summary>Own local direction of the joint's X, of any length.</summary>
    public Vector3d Axis
    {
        get => axis;
        init => axis = value;
    }

    /// <summary>When true, Unity computes <see cref="ConnectedAnchor"/> from <see cref="Anchor"/> at start-up.</summary>
    public bool AutoConfigureConnectedAnchor
    {
        get => autoConfigureConnectedAnchor;
        init => autoConfigureConnectedAnchor = value;
    }

    /// <summary>Connected body's local space (scaled), or the world's when there is none; metres.</summary>
    public Vector3d ConnectedAnchor
    {
        get => connectedAnchor;
        init => connectedAnchor = value;
    }

    private protected void ReadAnchoredJointField(ref JsonCursor json, string field)
    {
        switch (field)
        {
            case "anchor":
                anchor = json.Vector3();
                break;
            case "axis":
                axis = json.Vector3();
                break;
            case "autoConfigureConnectedAnchor":
                autoConfigureConnectedAnchor = json.Boolean();
                break;
            case "connectedAnchor":
                connectedAnchor = json.Vector3();
                break;
            default:
                ReadJointField(ref json, field);
                break;
        }
    }
}
