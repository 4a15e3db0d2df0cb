using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json.Nodes;
using Kinefab.Tests.Conformance;
using KinefabUnity;
using KinefabUnity.Editing;
using NUnit.Framework;
using UnityEditor;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>What an import leaves: identifiers that last, findings with codes, and no half asset.</summary>
[NonParallelizable]
public sealed class KinefabImporterTests
{
    private static readonly string Invalid = Path.Combine(ConformanceCases.Folder, "invalid");

    [Test]
    public void Import_Lever_IsAPrefabWithItsAssets()
    {
        using var scene = new EditedScene();
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        Assert.That(asset.Context.Errors, Is.Empty);
        Assert.That(asset.Context.Objects.Keys.Single(k => k.Type == typeof(Unity.GameObject)).Identifier, Is.EqualTo("root"));
        Assert.That(asset.Identifiers("meshes"), Is.Not.Empty);
        Assert.That(asset.Identifiers("materials"), Is.Not.Empty);
        Assert.That(asset.Context.Sources, Is.EqualTo(scene.Json["buffers"]!.AsArray().Select(b => $"{Path.GetDirectoryName(scene.Scene)!.Replace('\\', '/')}/{b!["uri"]}")));
        Assert.That(asset.Source.Load().Document.GameObjects, Has.Count.EqualTo(scene.Objects.Count));
    }

    // Unity finds a sub-asset again by class and identifier, an object by the names above it.
    [TestCaseSource(typeof(PlayedMechanism), nameof(PlayedMechanism.Scenes))]
    public void Import_OfReorderedObjects_HasTheSameIdentities(string path)
    {
        using var scene = new EditedScene(path);
        HashSet<string> before = References(ImportedAsset.Of(scene.Scene));
        var random = new Random(path.Length);
        scene.Reorder(_ => random.Next());
        Assert.That(References(ImportedAsset.Of(scene.Scene)), Is.EquivalentTo(before));
    }

    [Test]
    public void Import_WithAnObjectMore_KeepsAllOthers()
    {
        using var scene = new EditedScene();
        HashSet<string> before = References(ImportedAsset.Of(scene.Scene));
        JsonNode more = scene.Objects[1]!.DeepClone();
        more["id"] = "~more";
        more["components"] = new JsonArray();
        scene.Objects.Add(more);
        scene.Save();
        HashSet<string> after = References(ImportedAsset.Of(scene.Scene));
        Assert.That(before, Is.SubsetOf(after), "though it has the name of one that was there");
        Assert.That(after, Has.Count.EqualTo(before.Count + 2));
    }

    [Test]
    public void Import_WithoutItsLastObject_KeepsAllOthers()
    {
        using var scene = new EditedScene();
        HashSet<string> before = References(ImportedAsset.Of(scene.Scene));
        int last = scene.Objects.Count - 1;
        scene.Objects[last]!["components"] = new JsonArray();
        scene.Save();
        string gone = $"/{scene.Objects[last]!["name"]}";
        HashSet<string> after = References(ImportedAsset.Of(scene.Scene));
        Assert.That(before.Except(after).Where(r => r.StartsWith("root", StringComparison.Ordinal)), Is.All.Contains(gone));
    }

    // Unity's own rule: an object is its path of names, so that a renamed one is another; all else stays.
    // What a second export may do at once: some parts gone, some more, all in another order. Nobody else's references change.
    [TestCaseSource(typeof(PlayedMechanism), nameof(PlayedMechanism.Scenes))]
    public void Import_OfASecondExport_KeepsWhatIsStillThere(string path)
    {
        using var scene = new EditedScene(path);
        var random = new Random(path.Length);
        for (int i = 0; i < 3; i++)
        {
            var more = new JsonObject { ["id"] = $"more {i}", ["name"] = $"More {i}", ["parent"] = random.Next(scene.Objects.Count) };
            scene.Objects.Add(more);
        }

        scene.Save();
        HashSet<string> before = References(ImportedAsset.Of(scene.Scene));
        scene.Objects.RemoveAt(scene.Objects.Count - 1);
        scene.Objects.Add(new JsonObject { ["id"] = "another", ["name"] = "Another", ["parent"] = random.Next(scene.Objects.Count - 2) });
        scene.Reorder(_ => random.Next());
        HashSet<string> after = References(ImportedAsset.Of(scene.Scene));
        Assert.That(before.Except(after), Is.All.Contains("/More 2").And.Not.Empty);
        Assert.That(after.Except(before), Is.All.Contains("/Another").And.Not.Empty);
    }

    [Test]
    public void Import_OfARenamedObject_KeepsMeshesMaterialsAndTheOthers()
    {
        using var scene = new EditedScene();
        HashSet<string> before = References(ImportedAsset.Of(scene.Scene));
        int last = scene.Objects.Count - 1;
        string old = (string)scene.Objects[last]!["name"]!;
        scene.Save(json => scene.Objects[last]!["name"] = "Renamed");
        HashSet<string> after = References(ImportedAsset.Of(scene.Scene));
        Assert.That(before.Except(after), Is.All.StartsWith("root").And.All.Contains($"/{old}"));
    }

    [Test]
    public void Import_OfAMovedFile_HasTheSameIdentities()
    {
        using var scene = new EditedScene();
        HashSet<string> before = References(ImportedAsset.Of(scene.Scene));
        string other = Path.Combine(scene.Folder, "other.kinefab").Replace('\\', '/');
        File.Move(scene.Scene, other);
        Assert.That(References(ImportedAsset.Of(other)), Is.EquivalentTo(before));
    }

    [Test]
    public void Import_Twice_GivesTheSame()
    {
        using var scene = new EditedScene();
        var first = References(ImportedAsset.Of(scene.Scene));
        Assert.That(References(ImportedAsset.Of(scene.Scene)), Is.EquivalentTo(first));
    }

    // So that no name can clash with another asset's.
    [Test]
    public void Import_WritesNothingBesideItself()
    {
        using var scene = new EditedScene();
        string[] before = [.. Directory.GetFileSystemEntries(scene.Folder, "*", SearchOption.AllDirectories).Order(StringComparer.Ordinal)];
        string[] assets = [.. AssetDatabase.Assets.Keys.Order(StringComparer.Ordinal)];
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        Assert.That(asset.Context.Errors, Is.Empty);
        Assert.That(Directory.GetFileSystemEntries(scene.Folder, "*", SearchOption.AllDirectories).Order(StringComparer.Ordinal), Is.EqualTo(before));
        Assert.That(AssetDatabase.Assets.Keys.Order(StringComparer.Ordinal), Is.EqualTo(assets));

        // What is called as the file's own objects and assets are is another identifier.
        scene.Save(json =>
        {
            foreach (JsonNode? material in json["materials"]!.AsArray())
                material!["name"] = "root";
            scene.Objects[0]!["name"] = "Mechanism";
        });
        ImportedAsset alike = ImportedAsset.Of(scene.Scene);
        Assert.That(alike.Context.Errors, Is.Empty);
        Assert.That(alike.Identifiers("materials").Distinct().Count(), Is.EqualTo(asset.Identifiers("materials").Count()));
    }

    private static IEnumerable<string> Broken() => Directory.GetFiles(Invalid, "*.kinefab", SearchOption.AllDirectories)
        .Where(path => !path.Contains($"{Path.DirectorySeparatorChar}source{Path.DirectorySeparatorChar}", StringComparison.Ordinal))
        .Select(path => Path.GetRelativePath(Invalid, path)).Order(StringComparer.Ordinal);

    // Never an exception, never half an asset: an error with its code, or an asset whose warnings are told.
    [TestCaseSource(nameof(Broken))]
    public void Import_OfAFaultyFile_IsAnErrorOrAWholeAsset(string path)
    {
        JsonArray report = JsonNode.Parse(File.ReadAllText(Path.ChangeExtension(Path.Combine(Invalid, path), ".report.json")))!.AsArray();
        bool isError = report.Any(d => (string)d!["severity"]! == "error");
        string[] codes = [.. report.Where(d => !isError || (string)d!["severity"]! == "error").Select(d => (string)d!["code"]!)];
        ImportedAsset asset = ImportedAsset.Of(Path.Combine(Invalid, path));
        Assert.That((asset.Context.Errors.Count > 0, asset.Context.mainObject == null!), Is.EqualTo((isError, isError)));
        Assert.That(asset.Context.Objects, asset.Context.Errors.Count > 0 ? Is.Empty : Is.Not.Empty);
        string told = string.Join("\n", asset.Context.Errors.Concat(asset.Context.Warnings).Concat(asset.Context.mainObject == null! ? [] : asset.Source.Findings.Select(f => f.ToString())));
        foreach (string code in codes.Distinct())
            Assert.That(told, Does.Contain(code));
    }

    [Test]
    public void Import_OfAFaultyFile_NamesLineAndPointer()
    {
        ImportedAsset asset = ImportedAsset.Of(Path.Combine(Invalid, "gameobject", "parent_later.kinefab"));
        Assert.That(asset.Context.Errors.Single(), Does.Match(@"parent_later\.kinefab: [A-Z_]+ \(line \d+, /gameObjects/\d+/parent\): .+\. .+\."));
    }

    [Test]
    public void Import_WithoutItsBuffer_IsAnErrorAndComesWithIt()
    {
        using var scene = new EditedScene();
        string buffer = Path.Combine(scene.Folder, (string)scene.Json["buffers"]![0]!["uri"]!);
        File.Move(buffer, buffer + ".away");
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        Assert.That(asset.Context.Errors.Single(), Does.Contain("BUFFER_MISSING"));
        Assert.That(asset.Context.Sources, Has.Count.EqualTo(1), "so that it is imported again when the buffer comes");
        Assert.That(asset.Context.Objects, Is.Empty);
        File.Move(buffer + ".away", buffer);
        Assert.That(ImportedAsset.Of(scene.Scene).Context.Errors, Is.Empty);
    }

    [TestCase("{\"format\": \"other\", \"version\": \"1.0\", \"gameObjects\": []}", "FORMAT_UNKNOWN")]
    [TestCase("{\"format\": \"kinefab.scene\", \"version\": \"2.0\", \"gameObjects\": []}", "VERSION_UNSUPPORTED")]
    [TestCase("<robot name=\"arm\"/>", "FORMAT_MISSING")]
    [TestCase("\n#usda 1.0", "FORMAT_MISSING")]
    [TestCase("x{\"format\": \"kinefab.scene\", \"version\": \"1.0\", \"gameObjects\": []}", "JSON_SYNTAX")]
    [TestCase("PK\u0003\u0004 not a scene at all", "FORMAT_MISSING")]
    [TestCase("", "SCENE_EMPTY")]
    public void Import_OfSomethingElse_IsASentence(string text, string code)
    {
        using var scene = new EditedScene();
        File.WriteAllText(scene.Scene, text);
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        Assert.That(string.Join("\n", asset.Context.Errors), Does.Contain(code));
        Assert.That(asset.Context.Objects, Is.Empty);
    }

    [Test]
    public void Import_OfANewerMinorVersion_ReadsItAndSaysSo()
    {
        using var scene = new EditedScene();
        scene.Save(json => json["version"] = "1.99");
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        Assert.That(asset.Codes, Does.Contain("VERSION_NEWER"));
        Assert.That(asset.Context.Errors, Is.Empty);
    }

    [Test]
    public void Import_OfAFileThatIsNotThere_IsASentence() =>
        Assert.That(ImportedAsset.Of("/nowhere/lever.kinefab").Context.Errors.Single(), Does.Contain("SCENE_NOT_FOUND"));

    [Test]
    public void Import_OfTenThousandParts_ShowsHowFarItIs()
    {
        using var scene = new EditedScene();
        JsonNode part = new JsonObject { ["name"] = "Part", ["parent"] = 0, ["transform"] = new JsonObject { ["localPosition"] = new JsonArray(1, 2, 3) } };
        for (int i = 0; i < 10_000; i++)
        {
            JsonNode next = part.DeepClone();
            next["id"] = $"part {i}";
            scene.Objects.Add(next);
        }

        scene.Save();
        EditorUtility.Progress.Clear();
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        Assert.That(asset.Context.Errors, Is.Empty);
        Assert.That(EditorUtility.Progress, Is.Ordered.And.Property("Count").GreaterThan(30));
        Assert.That((EditorUtility.Progress[^1], EditorUtility.IsBarShown), Is.EqualTo((1f, false)));
        Assert.That(asset.Root.GetComponentsInChildren<Unity.Transform>(true).Count(t => t.name.StartsWith("Part", StringComparison.Ordinal)), Is.EqualTo(10_000));
    }

    [Test]
    public void Import_OfNothing_IsAnEmptyObject()
    {
        using var scene = new EditedScene();
        File.WriteAllText(scene.Scene, """{"format": "kinefab.scene", "version": "1.0", "gameObjects": []}""");
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        Assert.That(asset.Context.Errors, Is.Empty);
        Assert.That(asset.Root.transform.childCount, Is.Zero);
    }

    [Test]
    public void Import_WithoutThePipelinesShader_SaysSoAndMakesTheRest()
    {
        using var scene = new EditedScene();
        Unity.Shader standard = Unity.Shader.Known["Standard"];
        Unity.Shader.Known.Remove("Standard");
        try
        {
            ImportedAsset asset = ImportedAsset.Of(scene.Scene);
            Assert.That(asset.Codes.Count(c => c == "UNITY_SHADER_MISSING"), Is.EqualTo(1));
            Assert.That(asset.Context.Warnings, Has.Some.Contains("Standard").And.Some.Contains("Install the package"));
            Assert.That(asset.Identifiers("meshes"), Is.Not.Empty);
        }
        finally
        {
            Unity.Shader.Known["Standard"] = standard;
        }
    }

    [Test]
    public void Import_InAnotherPipeline_HasItsMaterialsAndComesAgainWhenItChanges()
    {
        using var scene = new EditedScene();
        Register();
        Unity.Hash128 before = AssetDatabase.Dependencies[ProjectDependency.Name];
        int refreshed = AssetDatabase.Refreshed;
        using RenderPipelines urp = RenderPipelines.Use("urp");
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        Unity.Material[] materials = [.. asset.Context.Objects.Values.OfType<Unity.Material>()];
        Assert.That(materials.Select(m => m.shader.name), Is.All.EqualTo("Universal Render Pipeline/Lit"));
        Assert.That(asset.Context.Custom, Does.Contain(ProjectDependency.Name));
        Assert.That(AssetDatabase.Dependencies[ProjectDependency.Name], Is.Not.EqualTo(before));

        // Unity imports what depends on it at its next refresh, which nobody else asks for.
        Assert.That(AssetDatabase.Refreshed, Is.EqualTo(refreshed), "the frame is over first");
        EditorApplication.Idle();
        Assert.That(AssetDatabase.Refreshed, Is.GreaterThan(refreshed));
    }

    // From 2022.2 a body keeps its inertia, from 6000.3.9 slides run the other way: what an older editor has made is not what this one needs.
    [Test]
    public void Import_InAnotherEditor_ComesAgain()
    {
        Register();
        Unity.Hash128 before = AssetDatabase.Dependencies[ProjectDependency.Name];
        string editor = Unity.Application.unityVersion;
        Unity.Application.unityVersion = "2021.3.45f1";
        try
        {
            Register();
            Assert.That(AssetDatabase.Dependencies[ProjectDependency.Name], Is.Not.EqualTo(before));
        }
        finally
        {
            Unity.Application.unityVersion = editor;
            Register();
        }
    }

    private static void Register() =>
        typeof(ProjectDependency).GetMethod("Register", System.Reflection.BindingFlags.Static | System.Reflection.BindingFlags.NonPublic)!.Invoke(null, null);

    [Test]
    public void Import_WithARemappedMaterial_ShowsTheUsersAndKeepsTheIdentifiers()
    {
        using var scene = new EditedScene();
        ImportedAsset before = ImportedAsset.Of(scene.Scene);
        string name = before.Identifiers("materials").First()["materials/".Length..];
        var own = new Unity.Material(Unity.Shader.Find("Standard")) { name = "Users" };
        var importer = new KinefabImporter();
        importer.AddRemap(new AssetImporter.SourceAssetIdentifier(typeof(Unity.Material), name), own);
        ImportedAsset after = ImportedAsset.Of(scene.Scene, importer: importer);
        Assert.That(importer.SupportsRemappedAssetType(typeof(Unity.Material)));
        Assert.That(References(after), Is.EquivalentTo(References(before)));
        Unity.Material[] shown = [.. after.Root.GetComponentsInChildren<Unity.MeshRenderer>(true).SelectMany(r => r.sharedMaterials)];
        Assert.That(shown, Does.Contain(own));
        Assert.That(shown.Where(m => m != own).Select(m => m.name), Does.Not.Contain(name));
    }

    [Test]
    public void Import_Settings_AreKept()
    {
        using var scene = new EditedScene();
        var settings = new KinefabSettings { physics = KinefabPhysics.None, colliders = false, readWrite = false, lightmapUVs = true };
        ImportedAsset asset = ImportedAsset.Of(scene.Scene, settings);
        Unity.Component[] all = asset.Root.GetComponentsInChildren<Unity.Component>(true);
        Assert.That(all.Where(c => c is Unity.Rigidbody or Unity.Joint or Unity.Collider), Is.Empty);
        Assert.That(asset.Context.Objects.Values.OfType<Unity.Mesh>().Select(m => (m.isReadable, m.uv2.Length == m.vertexCount)), Is.All.EqualTo((false, true)));
    }

    [Test]
    public void Import_Ground_StandsStill()
    {
        using var scene = new EditedScene();
        string id = (string)scene.Objects.First(o => o!["components"]?.AsArray().Any(c => (string)c!["type"]! == "Rigidbody" && c["isKinematic"] is null) == true)!["id"]!;
        ImportedAsset free = ImportedAsset.Of(scene.Scene), held = ImportedAsset.Of(scene.Scene, new KinefabSettings { ground = id });
        Assert.That(Kinematic(held), Is.EqualTo(Kinematic(free) + 1));
        Assert.That(ImportedAsset.Of(scene.Scene, new KinefabSettings { ground = "nobody" }).Codes, Does.Contain("UNITY_GROUND_UNKNOWN"));
    }

    [Test]
    public void Import_JointsOfTheWorld_AreTold()
    {
        ImportedAsset asset = ImportedAsset.Of(Path.Combine(ConformanceCases.Folder, "valid", "hinge", "world.kinefab"));
        Assert.That(asset.Codes, Does.Contain("UNITY_JOINT_OF_WORLD"));
    }

    [Test]
    public void Import_WherePhysicsIsOff_SaysSo()
    {
        using var scene = new EditedScene();
        Unity.IntegrationInfo before = Unity.Physics.Integration;
        Unity.Physics.Integration = new Unity.IntegrationInfo { name = "None", isFallback = true };
        try
        {
            Assert.That(ImportedAsset.Of(scene.Scene).Codes, Does.Contain("UNITY_PHYSICS_OFF"));
            Assert.That(ImportedAsset.Of(scene.Scene, new KinefabSettings { physics = KinefabPhysics.None }).Codes, Does.Not.Contain("UNITY_PHYSICS_OFF"));
        }
        finally
        {
            Unity.Physics.Integration = before;
        }
    }

    [Test]
    public void Import_Losses_AreToldWithCodeAndFeature()
    {
        using var scene = new EditedScene();
        scene.Save(json => json["report"] = new JsonArray(new JsonObject { ["feature"] = "coupling Gear", ["outcome"] = "dropped", ["severity"] = "warning", ["code"] = "COLLIDER_EMPTY", ["message"] = "It went." }));
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        KinefabFinding loss = asset.Source.Findings.Single(f => f.place == "coupling Gear");
        Assert.That((loss.code, loss.message, loss.severity), Is.EqualTo(("COLLIDER_EMPTY", "It went.", KinefabSeverity.Warning)));
        Assert.That(asset.Context.Warnings, Has.Some.Contains("coupling Gear"));
    }

    [Test]
    public void Import_OfAFileThatHoldsItsBuffer_NeedsNothingBesideIt()
    {
        string path = Path.Combine(ConformanceCases.Folder, "valid", "container", "one_file.kinefab");
        ImportedAsset asset = ImportedAsset.Of(path);
        Assert.That(asset.Context.Errors, Is.Empty);
        Assert.That(asset.Context.Sources, Is.Empty);
        Assert.That(asset.Identifiers("meshes"), Is.Not.Empty);
        Assert.That(asset.Source.Load().Document.GameObjects, Is.Not.Empty);
    }

    [Test]
    public void Dependencies_OfAFaultyFile_AreNone()
    {
        using var scene = new EditedScene();
        Assert.That(Gathered(scene.Scene), Has.Length.EqualTo(1));
        File.WriteAllText(scene.Scene, "{");
        Assert.That(Gathered(scene.Scene), Is.Empty);
    }

    private static string[] Gathered(string path) =>
        (string[])typeof(KinefabImporter).GetMethod("GatherDependenciesFromSourceFile", System.Reflection.BindingFlags.Static | System.Reflection.BindingFlags.NonPublic)!.Invoke(null, [path])!;

    private static int Kinematic(ImportedAsset asset) => asset.Root.GetComponentsInChildren<Unity.Rigidbody>(true).Count(b => b.isKinematic);

    // What users' scenes refer to: class and identifier of sub-assets, and of objects and components the path of names below the root's.
    private static HashSet<string> References(ImportedAsset asset)
    {
        HashSet<string> found = [.. asset.Context.Objects.Keys.Select(k => $"{k.Type.Name}->{k.Identifier}")];
        Collect(asset.Root, $"root/{asset.Root.name}", found);
        return found;
    }

    private static void Collect(Unity.GameObject at, string path, HashSet<string> found)
    {
        found.Add(path);
        foreach (IGrouping<string, Unity.Component> kind in at.Components.GroupBy(c => c.GetType().Name))
            found.Add($"{path}/{kind.Key}{kind.Count() - 1}");
        foreach (Unity.Transform child in at.transform.Children)
            Collect(child.gameObject, $"{path}/{child.name}", found);
    }
}
