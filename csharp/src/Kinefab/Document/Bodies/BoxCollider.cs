using Kinefab.Json;
using Kinefab.Numerics;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>BoxCollider.</summary>
public sealed record BoxCollider : Collider
{
    internal static readonly FieldNames Fields = new(
        ["type"],
        [
            .. ColliderFields,
            "center", "size", "extras",
        ]);

    /// <summary>Unity's defaults.</summary>
    public BoxCollider()
    {
    }

    internal BoxCollider(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "center":
                    Center = json.Vector3();
                    break;
                case "size":
                    Size = json.Vector3();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
                default:
                    ReadColliderField(ref json, fields.Name);
                    break;
            }
        }
    }

    /// <summary>Local, metres.</summary>
    public Vector3d Center { get; init; }

    /// <summary>Full size, local, metres.</summary>
    public Vector3d Size { get; init; } = new(1, 1, 1);

    private protected override string Describe() => Line($"BoxCollider {Size} m at {Center} m{(IsTrigger ? ", trigger" : "")}");
}
