using Kinefab.Json;
using Kinefab.Numerics;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>CapsuleCollider.</summary>
public sealed record CapsuleCollider : Collider
{
    internal static readonly FieldNames Fields = new(
        ["type"],
        [
            .. ColliderFields,
            "center", "radius", "height", "direction", "extras",
        ]);

    /// <summary>Unity's defaults.</summary>
    public CapsuleCollider()
    {
    }

    internal CapsuleCollider(ref JsonCursor json)
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
                case "height":
                    Height = json.Number();
                    break;
                case "direction":
                    Direction = json.Word(AxisWords.Table);
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

    /// <summary>Metres.</summary>
    public double Radius { get; init; } = 0.5;

    /// <summary>With both caps, metres.</summary>
    public double Height { get; init; } = 1;

    /// <summary>The local axis that the capsule lies along.</summary>
    public Axis Direction { get; init; } = Axis.Y;

    private protected override string Describe() => Line($"CapsuleCollider of radius {Radius} m and height {Height} m along {Direction} at {Center} m{(IsTrigger ? ", trigger" : "")}");
}
