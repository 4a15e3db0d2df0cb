using System;
using System.Collections.Generic;
using System.IO;
using System.IO.Compression;
using System.Linq;
using System.Security.Cryptography;
using System.Text.Json.Nodes;
using KinefabUnity;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>Textures, layers and tags of an import; that they are the prefab's own, PrefabTests see.</summary>
[NonParallelizable]
public sealed class LookImportTests
{
    private const string Textured = "../tests/conformance/valid/look/textured.kinefab";

    private static readonly string[] Uses =
    [
        "textures/tiles.png|color|clamp", "textures/tiles.png|color|repeat", "textures/bumps.png|normal|mirror", "textures/Tiles|mask|bumps.png|repeat",
    ];

    private static readonly int[] PillowsShade = [110, 106, 161, 114, 94, 202];

    private static readonly string[] OfTiles = ["color texture of material Tiles", "emission texture of material Tiles"];

    private static readonly string[] OfStandard =
    [
        "other side of material Tiles", "uvSet of color texture of material Tiles", "rotation of color texture of material Tiles",
        "its own scale and offset of normal texture of material Tiles", "vertex colours of mesh triangle",
    ];

    [Test]
    public void Textures_AreSubAssetsOneForEachUse()
    {
        using var scene = new EditedScene(Textured);
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        Assert.That(asset.Context.Errors, Is.Empty);
        Assert.That(asset.Identifiers("textures"), Is.EquivalentTo(Uses));
        Assert.That(Texture(asset, "tiles.png|color|clamp").IsLinear, Is.False);
        Assert.That(Texture(asset, "bumps.png|normal|mirror").IsLinear, Is.True);
    }

    // glTF's green is roughness and its blue metallic; the material's own factors are 0.125 and 0.75.
    [Test]
    public void Mask_HoldsMetallicOcclusionAndSmoothnessWithTheFactors()
    {
        using var scene = new EditedScene(Textured);
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        Unity.Color32[] from = Texture(asset, "tiles.png|color|repeat").GetPixels32(), to = Texture(asset, "Tiles|mask|bumps.png|repeat").GetPixels32();
        Assert.That(from.Distinct().Count(), Is.GreaterThan(1));
        Assert.That(to.Select(p => (p.r, p.g, p.b, p.a)), Is.EqualTo(from.Select(p => ((byte)Math.Round(0.125 * p.b), p.r, (byte)0, (byte)Math.Round(255 - 0.25 * p.g)))));
    }

    // The mask has the size of metallic and roughness; occlusion comes to it as Pillow resizes it (the numbers of ResamplingTests).
    [Test]
    public void Mask_OfOcclusionInAnotherSize_HasPillowsNumbers()
    {
        using var scene = new EditedScene(Textured);
        byte[] rough = Grey(3, 2, i => 90), occlusion = Grey(7, 5, i => (byte)(7 * i * i + 13 * i + i % 5 * 41)), both = [.. rough, .. new byte[-rough.Length & 3], .. occlusion];
        File.WriteAllBytes(Path.Combine(scene.Folder, "more.bin"), both);
        scene.Save(json =>
        {
            json["buffers"]!.AsArray().Add(new JsonObject { ["uri"] = "more.bin", ["byteLength"] = both.Length, ["sha256"] = Convert.ToHexStringLower(SHA256.HashData(both)) });
            foreach ((string name, int offset, int length) in new[] { ("rough.png", 0, rough.Length), ("shade.png", both.Length - occlusion.Length, occlusion.Length) })
                json["images"]!.AsArray().Add(new JsonObject { ["name"] = name, ["mediaType"] = "image/png", ["colorSpace"] = "linear", ["data"] = new JsonObject { ["buffer"] = 1, ["offset"] = offset }, ["byteLength"] = length });
            json["materials"]![0]!["metallicRoughnessTexture"]!["image"] = 2;
            json["materials"]![0]!["occlusionTexture"]!["image"] = 3;
        });
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        Assert.That(asset.Context.Errors, Is.Empty);
        Unity.Texture2D mask = asset.Context.Objects.Values.OfType<Unity.Texture2D>().Single(t => t.width == 3);

        // Unity's rows go upwards, an image's downwards.
        Unity.Color32[] pixels = mask.GetPixels32();
        int[] shown = [.. pixels[3..].Concat(pixels[..3]).Select(p => (int)p.g)];
        Assert.That(shown, Is.EqualTo(PillowsShade));
    }

    [Test]
    public void Identifiers_OfTexturesAndMaterials_DependOnNoOrder()
    {
        using var scene = new EditedScene(Textured);
        scene.Save(json =>
        {
            // Another material and image of the same names, apart by what they hold.
            JsonNode more = json["materials"]![0]!.DeepClone(), image = json["images"]![0]!.DeepClone();
            image["data"]!["offset"] = 0;
            image["mediaType"] = "image/x-other";
            json["images"]!.AsArray().Add(image);
            more["metallic"] = 0.5;
            more["colorTexture"]!["image"] = 2;
            json["materials"]!.AsArray().Add(more);
            JsonNode two = json["gameObjects"]![0]!.DeepClone();
            (two["id"], two["name"]) = ("b", "B");
            two["components"]![1]!["materials"] = new JsonArray(1);
            json["gameObjects"]!.AsArray().Add(two);
        });
        string[] before = Told(ImportedAsset.Of(scene.Scene));
        Assert.That(before, Has.Length.EqualTo(before.Distinct().Count()));
        scene.Save(json =>
        {
            JsonNode[] materials = [.. json["materials"]!.AsArray().Select(m => m!.DeepClone()).Reverse()];
            json["materials"] = new JsonArray(materials);
            foreach (JsonNode? entry in json["gameObjects"]!.AsArray())
                entry!["components"]![1]!["materials"]![0] = 1 - (int)entry["components"]![1]!["materials"]![0]!;
        });
        Assert.That(Told(ImportedAsset.Of(scene.Scene)), Is.EqualTo(before));
    }

    [Test]
    public void Image_ThatUnityCannotRead_IsToldAndTheMaterialStays()
    {
        using var scene = new EditedScene(Textured);
        scene.Save(json => json["images"]![0]!["byteLength"] = 20);
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        Assert.That(asset.Source.Findings.Where(f => f.code == "TEXTURE_NOT_WRITTEN").Select(f => f.place), Is.EquivalentTo(OfTiles));
        Assert.That(asset.Identifiers("materials"), Has.Exactly(1).Items);
        Assert.That(asset.Context.Objects.Values.OfType<Unity.Material>().Single().GetTexture("_BumpMap"), Is.Not.Null);
        Assert.That(asset.Context.Objects.Values.OfType<Unity.Texture2D>().Count(), Is.EqualTo(2), "none of what is not there");
    }

    [Test]
    public void NormalMap_WithAlpha_HasNoneInUnity()
    {
        using var scene = new EditedScene(Textured);
        Assert.That(Texture(ImportedAsset.Of(scene.Scene), "bumps.png|normal|mirror").GetPixels32().Select(p => p.a), Is.All.EqualTo(255));
    }

    [Test]
    public void Losses_OfTheShader_AreTold()
    {
        using var scene = new EditedScene(Textured);
        string[] told = [.. ImportedAsset.Of(scene.Scene).Source.Findings.Where(f => f.code is "TARGET_FIELD_DROPPED" or "LOOK_NOT_SHOWN").Select(f => f.place)];
        Assert.That(told, Is.SupersetOf(OfStandard));
        using RenderPipelines hdrp = RenderPipelines.Use("hdrp");
        string[] less = [.. ImportedAsset.Of(scene.Scene).Source.Findings.Where(f => f.code is "TARGET_FIELD_DROPPED" or "LOOK_NOT_SHOWN").Select(f => f.place)];
        Assert.That(less, Has.None.StartsWith("other side").And.None.Contains("scale and offset of emission"));
    }

    [Test]
    public void LayerAndTag_AreTheProjectsOrAreTold()
    {
        using var scene = new EditedScene();
        scene.Save(json =>
        {
            json["version"] = "1.1";
            for (int i = 0; i < 3; i++)
                (scene.Objects[i]!["layer"], scene.Objects[i]!["tag"]) = (i < 2 ? "Robots" : "Water", i < 1 ? "Player" : "Gripper");
        });
        ImportedAsset lacking = ImportedAsset.Of(scene.Scene);
        Assert.That(lacking.Context.Errors, Is.Empty);
        Assert.That(lacking.Context.Warnings.Where(w => w.Contains("UNITY_LAYER_OR_TAG_MISSING", StringComparison.Ordinal)), Has.Exactly(2).Items.And.Some.Contains("no layer Robots, which 2 object(s)").And.Some.Contains("no tag Gripper, which 2 object(s)"));
        Assert.That(LayersAndTags(lacking), Is.EquivalentTo(new[] { (4, "Untagged"), (0, "Player") }));
        Unity.LayerMask.Layers.Add("Robots");
        Unity.GameObject.Tags.Add("Gripper");
        try
        {
            ImportedAsset whole = ImportedAsset.Of(scene.Scene);
            Assert.That(whole.Codes, Has.None.EqualTo("UNITY_LAYER_OR_TAG_MISSING"));
            Assert.That(LayersAndTags(whole), Is.EquivalentTo(new[] { (8, "Player"), (8, "Gripper"), (4, "Gripper") }));
        }
        finally
        {
            Unity.LayerMask.Layers.Remove("Robots");
            Unity.GameObject.Tags.Remove("Gripper");
        }
    }

    private static IEnumerable<(int Layer, string Tag)> LayersAndTags(ImportedAsset asset) =>
        asset.Root.GetComponentsInChildren<Unity.Transform>(true).Select(t => (t.gameObject.layer, t.gameObject.tag)).Where(p => p != (0, "Untagged"));

    private static Unity.Texture2D Texture(ImportedAsset asset, string identifier) =>
        (Unity.Texture2D)asset.Context.Objects[(typeof(Unity.Texture2D), $"textures/{identifier}")];

    // Each identifier with what it stands for.
    private static string[] Told(ImportedAsset asset) =>
    [
        .. asset.Context.Objects.Where(o => o.Value is Unity.Material or Unity.Texture2D)
            .Select(o => $"{o.Key.Identifier}: {(o.Value is Unity.Material m ? m.GetFloat("_Metallic") : ((Unity.Texture2D)o.Value).width)}").Order(StringComparer.Ordinal),
    ];

    // A PNG of 8 bits of grey.
    private static byte[] Grey(int width, int height, Func<int, byte> at)
    {
        using var packed = new MemoryStream();
        using (var zlib = new ZLibStream(packed, CompressionLevel.Fastest, leaveOpen: true))
        {
            for (int row = 0; row < height; row++)
                zlib.Write([0, .. Enumerable.Range(row * width, width).Select(at)]);
        }

        byte[] Chunk(string kind, byte[] data)
        {
            byte[] body = [.. kind.Select(c => (byte)c), .. data];
            return [.. Big(data.Length), .. body, .. Big((int)Crc(body))];
        }

        return [0x89, .. "PNG\r\n\u001a\n"u8, .. Chunk("IHDR", [.. Big(width), .. Big(height), 8, 0, 0, 0, 0]), .. Chunk("IDAT", packed.ToArray()), .. Chunk("IEND", [])];

        static byte[] Big(int value) => [(byte)(value >> 24), (byte)(value >> 16), (byte)(value >> 8), (byte)value];

        static uint Crc(byte[] data)
        {
            uint crc = uint.MaxValue;
            foreach (byte each in data)
            {
                crc ^= each;
                for (int bit = 0; bit < 8; bit++)
                    crc = (crc & 1) != 0 ? 0xEDB88320 ^ (crc >> 1) : crc >> 1;
            }

            return ~crc;
        }
    }
}
