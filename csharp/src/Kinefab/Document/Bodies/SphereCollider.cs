using Kinefab.Json;
using Kinefab.Numerics;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>SphereCollider.</summary>
public sealed record SphereCollider : Collider
{
    internal static readonly FieldNames Fields = new(
        ["type"],
        [
            .. ColliderFields,
            "center", "radius", "extras",
        ]);

    /// <summary>Unity's defaults.</summary>
    public SphereCollider()
    {
    }

    internal SphereCollider(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "center":
                    Center = json.Vector3();
                    break;
                case "radius":
                    Radius = json.Number();
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

    /// <summary>Metres, times the largest component of the world scale.</summary>
    public double Radius { get; init; } = 0.5;

    private protected override string Describe() => Line($"SphereCollider of radius {Radius} m at {Center} m{(IsTrigger ? ", trigger" : "")}");
}
