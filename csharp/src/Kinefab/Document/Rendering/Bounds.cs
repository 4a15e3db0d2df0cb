using Kinefab.Json;
using Kinefab.Numerics;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Axis-aligned box.</summary>
public sealed record Bounds : DocumentObject
{
    internal static readonly FieldNames Fields = new(["center", "extents"], "extras");

    /// <summary>With nothing stated.</summary>
    public Bounds()
    {
    }

    internal Bounds(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "center":
                    Center = json.Vector3();
                    break;
                case "extents":
                    Extents = json.Vector3();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Metres.</summary>
    public Vector3d Center { get; init; }

    /// <summary>Half sizes, metres.</summary>
    public Vector3d Extents { get; init; }
}
