namespace Kinefab.Document;

/// <summary>A surface in Unity's Standard and Lit terms.</summary>
public sealed class Material : DocumentObject
{
    /// <summary>Material.name.</summary>
    public string Name { get; init; } = "";

    /// <summary>Base colour.</summary>
    public Color Color { get; init; } = Color.White;

    /// <summary>0 to 1.</summary>
    public double Metallic { get; init; }

    /// <summary>0 to 1.</summary>
    public double Smoothness { get; init; } = 0.5;
}
