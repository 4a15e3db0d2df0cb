using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Where the scene came from.</summary>
public sealed record SceneSource : DocumentObject
{
    internal static readonly FieldNames Fields = new([], "uri", "upAxis", "metersPerUnit", "sha256", "extras");

    /// <summary>With nothing stated.</summary>
    public SceneSource()
    {
    }

    internal SceneSource(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "uri":
                    Uri = json.Text();
                    break;
                case "upAxis":
                    UpAxis = json.Word(AxisWords.Table);
                    break;
                case "metersPerUnit":
                    MetersPerUnit = json.Number();
                    break;
                case "sha256":
                    Sha256 = json.Text();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Source file, relative, as given.</summary>
    public string? Uri { get; init; }

    /// <summary>Up axis of the source.</summary>
    public Axis? UpAxis { get; init; }

    /// <summary>Metres in one length unit of the source.</summary>
    public double? MetersPerUnit { get; init; }

    /// <summary>SHA-256 of the source file's bytes, lower-case hexadecimal.</summary>
    public string? Sha256 { get; init; }
}
