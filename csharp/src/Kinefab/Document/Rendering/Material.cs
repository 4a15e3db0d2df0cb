using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>A surface in Unity's Standard and Lit terms.</summary>
public sealed record Material : DocumentObject
{
    internal static readonly FieldNames Fields = new(["name"], "color", "metallic", "smoothness", "extras");

    /// <summary>With nothing stated.</summary>
    public Material()
    {
    }

    internal Material(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "name":
                    Name = json.Text();
                    break;
                case "color":
                    Color = Color.Read(ref json);
                    break;
                case "metallic":
                    Metallic = json.Number();
                    break;
                case "smoothness":
                    Smoothness = json.Number();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Material.name.</summary>
    public string Name { get; init; } = "";

    /// <summary>Base colour.</summary>
    public Color Color { get; init; } = Color.White;

    /// <summary>0 to 1.</summary>
    public double Metallic { get; init; }

    /// <summary>0 to 1.</summary>
    public double Smoothness { get; init; } = 0.5;

    private protected override string Describe() => Line($"material \"{Name}\", metallic {Metallic}, smoothness {Smoothness}");
}
