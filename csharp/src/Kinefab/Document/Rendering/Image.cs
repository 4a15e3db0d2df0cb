namespace Kinefab.Document;

/// <summary>What the numbers of an image's colours mean.</summary>
public enum ColorSpace
{
    /// <summary>Colours as screens show them; Unity's sRGB (Color Texture).</summary>
    SRgb,

    /// <summary>Numbers as they are: normals, roughness, occlusion.</summary>
    Linear,
}

/// <summary>An image file, byte for byte, in a buffer: it is never decoded here.</summary>
[Since(1)]
public sealed partial record Image : DocumentObject
{
    /// <summary>Its name in the source.</summary>
    [Field(Required = true)]
    public string Name { get; init; } = "";

    /// <summary>What kind of file: image/png, image/jpeg.</summary>
    [Field(Required = true)]
    public string MediaType { get; init; } = "";

    /// <summary>What its numbers mean.</summary>
    public ColorSpace ColorSpace { get; init; }

    /// <summary>Where the file begins.</summary>
    [Field(Required = true)]
    public Accessor Data { get; init; } = new();

    /// <summary>Length of the file in bytes.</summary>
    [Field(Required = true)]
    public long ByteLength { get; init; }

    private protected override string Describe() => Line($"image \"{Name}\", {MediaType} of {ByteLength} bytes, {ColorSpace}");
}

/// <summary>The words of the scene file for <see cref="ColorSpace"/>.</summary>
internal static class ColorSpaceWords
{
    internal static readonly Json.Words<ColorSpace> Table = new(("sRGB", ColorSpace.SRgb), ("linear", ColorSpace.Linear));
}
