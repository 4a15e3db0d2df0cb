using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>What a texture shows beyond its edge.</summary>
[Words(Letters.Camel)]
public enum TextureWrap
{
    /// <summary>The image again.</summary>
    Repeat,

    /// <summary>Its edge.</summary>
    Clamp,

    /// <summary>The image the other way round.</summary>
    Mirror,
}

/// <summary>An image on a surface: uv' = R(rotation) (scale * uv) + offset, v upwards.</summary>
[Since(1)]
public sealed partial record Texture : DocumentObject
{
    /// <summary>Index into <see cref="SceneDocument.Images"/>.</summary>
    [Field(Required = true)]
    public int Image { get; init; }

    /// <summary>Which texture coordinates of the mesh it lies by: 0 for <see cref="Mesh.Uv"/>, 1 for <see cref="Mesh.Uv2"/>.</summary>
    public int UvSet { get; init; }

    /// <summary>What it shows beyond its edge.</summary>
    public TextureWrap Wrap { get; init; }

    /// <summary>How often it fits into one unit of u and v.</summary>
    public Vector2d Scale { get; init; } = new(1, 1);

    /// <summary>In parts of the image.</summary>
    public Vector2d Offset { get; init; }

    /// <summary>Degrees, from u to v.</summary>
    public double Rotation { get; init; }

    private protected override string Describe() => Line($"image {Image} by uv set {UvSet}, scale {Scale}, offset {Offset}, rotation {Rotation} deg, {Wrap}");
}
