using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>A run of values in a buffer, little-endian, tightly packed.</summary>
public sealed record Accessor : DocumentObject
{
    internal static readonly FieldNames Fields = new(["buffer", "offset"], "extras");

    /// <summary>With nothing stated.</summary>
    public Accessor()
    {
    }

    internal Accessor(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "buffer":
                    Buffer = json.Int();
                    break;
                case "offset":
                    Offset = json.Integer();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Index into <see cref="SceneDocument.Buffers"/>.</summary>
    public int Buffer { get; init; }

    /// <summary>Byte offset, a multiple of 4.</summary>
    public long Offset { get; init; }
}
