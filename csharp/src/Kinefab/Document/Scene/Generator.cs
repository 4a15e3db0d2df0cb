using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>The program that wrote the file.</summary>
public sealed record Generator : DocumentObject
{
    internal static readonly FieldNames Fields = new(["name", "version"], "extras");

    /// <summary>With nothing stated.</summary>
    public Generator()
    {
    }

    internal Generator(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "name":
                    Name = json.Text();
                    break;
                case "version":
                    Version = json.Text();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Its name.</summary>
    public string Name { get; init; } = "";

    /// <summary>Its version.</summary>
    public string Version { get; init; } = "";

    private protected override string Describe() => $"{Name} {Version}";
}
