using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>A range of indices that is drawn with one material.</summary>
public sealed record Submesh : DocumentObject
{
    internal static readonly FieldNames Fields = new(["indexStart", "indexCount"], "extras");

    /// <summary>With nothing stated.</summary>
    public Submesh()
    {
    }

    internal Submesh(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "indexStart":
                    IndexStart = json.Int();
                    break;
                case "indexCount":
                    IndexCount = json.Int();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>First index.</summary>
    public int IndexStart { get; init; }

    /// <summary>Number of indices, three a triangle.</summary>
    public int IndexCount { get; init; }
}
