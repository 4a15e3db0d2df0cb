namespace Kinefab.Document;

/// <summary>A surface in Unity's Standard and Lit terms.</summary>
public sealed partial record Material : DocumentObject
{
    /// <summary>Material.name.</summary>
    [Field(Required = true)]
    public string Name { get; init; } = "";

    /// <summary>Base colour.</summary>
    public Color Color { get; init; } = Color.White;

    /// <summary>0 to 1.</summary>
    public double Metallic { get; init; }

    /// <summary>0 to 1.</summary>
    public double Smoothness { get; init; } = 0.5;

    private protected override string Describe() => Line($"material \"{Name}\", metallic {Metallic}, smoothness {Smoothness}");
}
