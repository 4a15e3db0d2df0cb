using System;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>Materials, their textures and images.</summary>
internal static class LookRules
{
    private static ReadOnlySpan<byte> Png => [0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A];

    private static ReadOnlySpan<byte> Jpeg => [0xFF, 0xD8, 0xFF];

    internal static void Material(Material material, int images, in Place at)
    {
        NumberRules.Share(at, "color/0", material.Color.R);
        NumberRules.Share(at, "color/1", material.Color.G);
        NumberRules.Share(at, "color/2", material.Color.B);
        NumberRules.Share(at, "color/3", material.Color.A);
        NumberRules.Share(at, "metallic", material.Metallic);
        NumberRules.Share(at, "smoothness", material.Smoothness);
        NumberRules.Share(at, "alphaCutoff", material.AlphaCutoff);
        NumberRules.NotNegative(at, "emission/0", material.Emission.X);
        NumberRules.NotNegative(at, "emission/1", material.Emission.Y);
        NumberRules.NotNegative(at, "emission/2", material.Emission.Z);
        Texture(material.ColorTexture, "colorTexture", images, at);
        Texture(material.NormalTexture, "normalTexture", images, at);
        Texture(material.MetallicRoughnessTexture, "metallicRoughnessTexture", images, at);
        Texture(material.OcclusionTexture, "occlusionTexture", images, at);
        Texture(material.EmissionTexture, "emissionTexture", images, at);
    }

    /// <summary>The file lies in its buffer and begins as its kind does; it is not decoded.</summary>
    internal static void Image(Image image, bool[] usable, SceneDocument document, in Place at)
    {
        NumberRules.AtLeast(at, "byteLength", image.ByteLength, 0);
        if (image.ByteLength < 0 || !BufferRules.Accessor(image.Data, image.ByteLength, usable, document, "data", at))
            return;
        ReadOnlySpan<byte> beginning = image.MediaType switch
        {
            "image/png" => Png,
            "image/jpeg" => Jpeg,
            _ => default,
        };
        if (!document.BytesOf(image).Span.StartsWith(beginning))
            at.Report("data", DiagnosticCodes.ImageNotOfKind, ("mediaType", image.MediaType));
    }

    private static void Texture(Texture? texture, string field, int images, in Place at)
    {
        if (texture is null)
            return;
        NumberRules.Reference(at, field + "/image", texture.Image, "images", images);
        NumberRules.Between(at, field + "/uvSet", texture.UvSet, 0, MeshData.UvSets - 1);
        Finite(at, field + "/scale", texture.Scale);
        Finite(at, field + "/offset", texture.Offset);
        NumberRules.Finite(at, field + "/rotation", texture.Rotation);
    }

    private static void Finite(in Place at, string field, Vector2d value)
    {
        NumberRules.Finite(at, field + "/0", value.X);
        NumberRules.Finite(at, field + "/1", value.Y);
    }
}
