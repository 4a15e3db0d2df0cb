using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>How a surface's alpha is shown.</summary>
[Words(Letters.Camel)]
public enum AlphaMode
{
    /// <summary>Not at all.</summary>
    Opaque,

    /// <summary>Seen where alpha is not below the cut-off.</summary>
    Mask,

    /// <summary>Mixed with what is behind.</summary>
    Blend,
}

/// <summary>A surface in Unity's Standard and Lit terms; each number and colour is multiplied by its texture where there is one.</summary>
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

    /// <summary>How alpha is shown; null: blended where that of <see cref="Color"/> is below 1.</summary>
    [Since(1)]
    public AlphaMode? AlphaMode { get; init; }

    /// <summary>Of <see cref="AlphaMode.Mask"/>, 0 to 1.</summary>
    [Since(1)]
    public double AlphaCutoff { get; init; } = 0.5;

    /// <summary>Whether it is seen from behind.</summary>
    [Since(1)]
    public bool DoubleSided { get; init; }

    /// <summary>Linear red, green and blue of its own light, as components that may exceed 1.</summary>
    [Since(1)]
    public Vector3d Emission { get; init; }

    /// <summary>RGBA, sRGB.</summary>
    [Since(1)]
    public Texture? ColorTexture { get; init; }

    /// <summary>Tangent space, +Y up (OpenGL), linear.</summary>
    [Since(1)]
    public Texture? NormalTexture { get; init; }

    /// <summary>As glTF has it, linear: roughness, 1 - smoothness, in G, metallic in B.</summary>
    [Since(1)]
    public Texture? MetallicRoughnessTexture { get; init; }

    /// <summary>In R, linear.</summary>
    [Since(1)]
    public Texture? OcclusionTexture { get; init; }

    /// <summary>RGB, sRGB.</summary>
    [Since(1)]
    public Texture? EmissionTexture { get; init; }

    private protected override string Describe() => Line($"material \"{Name}\", metallic {Metallic}, smoothness {Smoothness}");
}
