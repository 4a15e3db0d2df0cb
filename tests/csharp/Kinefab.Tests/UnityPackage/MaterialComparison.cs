using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>A material of the package against one of Unity's files: every number, colour, keyword, pass and texture that the file states.</summary>
internal static class MaterialComparison
{
    // Switches at the shader's own default, which the package leaves to the template.
    private static readonly HashSet<string> OfTheTemplate = ["_SpecularHighlights", "_GlossyReflections", "_ReceiveShadows", "_EnvironmentReflections", "_QueueOffset"];

    private static readonly string[] Place = ["m_Scale.x", "m_Scale.y", "m_Offset.x", "m_Offset.y"];

    /// <param name="path">Of the .mat file.</param>
    /// <param name="assets">Files by their guids.</param>
    /// <param name="to">What the package made.</param>
    /// <param name="at">For messages.</param>
    /// <returns>How many fields were compared.</returns>
    public static int Same(string path, Dictionary<string, string> assets, Unity.Material to, string at)
    {
        PrefabFile.Record from = PrefabFile.Read(path).Documents.Values.First(d => d.Class == "Material");
        at = $"{at} {Path.GetFileName(path)}";
        int compared = 0;
        foreach ((string property, string[] rest, string value) in Properties(from, "m_Floats"))
        {
            if (!OfTheTemplate.Contains(property) && to.HasProperty(property))
            {
                Assert.That(to.GetFloat(property), Is.EqualTo(Number(value)).Within(1e-6), $"{at} {property}{string.Concat(rest)}");
                compared++;
            }
        }

        foreach (IGrouping<string, (string Property, string[] Parts, string Value)> color in Properties(from, "m_Colors").Where(c => c.Parts.Length > 0).GroupBy(c => c.Property))
        {
            if (!to.HasProperty(color.Key))
                continue;
            Unity.Color found = to.GetColor(color.Key);
            Dictionary<string, double> parts = color.ToDictionary(c => c.Parts[0], c => Number(c.Value));
            Assert.That(new double[] { found.r, found.g, found.b, found.a }, Is.EqualTo("rgba".Select(c => parts[$"{c}"])).Within(1e-6), $"{at} {color.Key}");
            compared += 4;
        }

        foreach (IGrouping<string, (string Property, string[] Parts, string Value)> map in Properties(from, "m_TexEnvs").Where(c => c.Parts.Length > 0).GroupBy(c => c.Property))
        {
            if (!to.HasProperty(map.Key))
                continue;
            Dictionary<string, string> parts = map.ToDictionary(c => string.Join('.', c.Parts), c => c.Value);
            SameTexture(parts.GetValueOrDefault("m_Texture.guid") is string guid ? assets[guid] : null, (Unity.Texture2D?)to.GetTexture(map.Key), $"{at} {map.Key}");
            Unity.Vector2 scale = to.GetTextureScale(map.Key), offset = to.GetTextureOffset(map.Key);
            Assert.That(
                new double[] { scale.x, scale.y, offset.x, offset.y },
                Is.EqualTo(Place.Select(p => Number(parts[p]))).Within(1e-6),
                $"{at} {map.Key}");
            compared += 5;
        }

        Assert.That(to.shaderKeywords, Is.EqualTo(List(from, "m_ValidKeywords").Order(StringComparer.Ordinal)), at);
        Assert.That(to.renderQueue, Is.EqualTo((int)Number(from["m_CustomRenderQueue"])), at);
        Assert.That(to.GetTag("RenderType", false), Is.EqualTo(from.Fields.GetValueOrDefault("stringTagMap.RenderType", "")), at);
        Assert.That((to.doubleSidedGI, (int)to.globalIlluminationFlags), Is.EqualTo((from["m_DoubleSidedGI"] == "1", (int)Number(from["m_LightmapFlags"]))), at);
        string[] off = [.. List(from, "disabledShaderPasses")];
        Assert.That(off.Where(to.GetShaderPassEnabled), Is.Empty, at);
        return compared + 5;
    }

    private static void SameTexture(string? path, Unity.Texture2D? to, string at)
    {
        Assert.That(to == null!, Is.EqualTo(path is null), at);
        if (path is null)
            return;
        at = $"{at} {Path.GetFileName(path)}";
        string[] meta = File.ReadAllLines(path + ".meta");
        bool Has(string line) => meta.Any(l => l.Trim() == line);
        Assert.That(to!.name, Is.EqualTo(Path.GetFileNameWithoutExtension(path).Split('~')[0]), at);
        Assert.That((to.IsLinear, to.HasMipmaps, to.IsApplied), Is.EqualTo((Has("sRGBTexture: 0"), true, true)), at);
        Assert.That(Has($"wrapU: {(int)to.wrapMode}"), at);
        Assert.That(Unity.Png.TryRead(File.ReadAllBytes(path), out int width, out int height, out Unity.Color32[] pixels), at);

        // Unity packs a normal map anew and takes no alpha from it.
        byte Alpha(Unity.Color32 pixel) => Has("textureType: 1") ? byte.MaxValue : pixel.a;
        Assert.That((to.width, to.height), Is.EqualTo((width, height)), at);
        Assert.That(to.GetPixels32().Select(p => (p.r, p.g, p.b, p.a)), Is.EqualTo(pixels.Select(p => (p.r, p.g, p.b, Alpha(p)))), at);
    }

    // "m_SavedProperties.m_Colors.3._Color.r".
    private static IEnumerable<(string Property, string[] Parts, string Value)> Properties(PrefabFile.Record from, string kind) =>
        from.Fields.Where(f => f.Key.StartsWith($"m_SavedProperties.{kind}.", StringComparison.Ordinal) && f.Value.Length > 0)
            .Select(f => (f.Key.Split('.'), f.Value)).Select(f => (f.Item1[3], f.Item1[4..], f.Value));

    private static IEnumerable<string> List(PrefabFile.Record from, string field)
    {
        for (int i = 0; from.Fields.TryGetValue($"{field}.{i}", out string? value); i++)
            yield return value;
    }

    private static double Number(string value) => double.Parse(value, CultureInfo.InvariantCulture);
}
