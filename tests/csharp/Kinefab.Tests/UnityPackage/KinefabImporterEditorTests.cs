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

/// <summary>The importer's inspector: what was found, each with what to do, and materials to replace.</summary>
[NonParallelizable]
public sealed class KinefabImporterEditorTests
{
    [SetUp]
    public void Clear() => EditorGUILayout.Shown.Clear();

    [TearDown]
    public void LetAnswersBe() => EditorGUILayout.Set = (label, value) => value;

    [Test]
    public void Inspector_OfAnAsset_ShowsSettingsAndFindings()
    {
        string path = Path.Combine(ConformanceCases.Folder, "valid", "hinge", "world.kinefab");
        ImportedAsset asset = ImportedAsset.Of(path);
        AssetDatabase.Assets[path] = [.. asset.Context.Objects.Values];
        Show(asset.Importer);
        Assert.That(EditorGUILayout.Shown, Does.Contain("settings"));
        Assert.That(EditorGUILayout.Shown, Has.Some.StartsWith("Warning: UNITY_JOINT_OF_WORLD").And.Some.Contains("KinefabScene.Instantiate"));
    }

    // Gravity, time step and iterations are the project's, so that a mechanism may move otherwise than it was exported for.
    [Test]
    public void Inspector_OfAnAsset_SetsTheProjectToWhatTheFileWasMadeFor()
    {
        using var scene = new EditedScene();
        scene.Save(json => json["physics"] = new JsonObject { ["gravity"] = new JsonArray(0, -1.62, 0), ["fixedTimestep"] = 0.01, ["solverIterations"] = 12 });
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        AssetDatabase.Assets[scene.Scene] = [.. asset.Context.Objects.Values];
        (Unity.Vector3 Gravity, int Iterations, float Step) before = (Unity.Physics.gravity, Unity.Physics.defaultSolverIterations, Unity.Time.fixedDeltaTime);
        try
        {
            Show(asset.Importer);
            Assert.That(EditorGUILayout.Shown, Has.Some.Contains("gravity (0, -1.62, 0), time step 0.01 s, 12 and 1 solver iterations"));
            Assert.That(Unity.Physics.gravity.y, Is.EqualTo(before.Gravity.y));
            Unity.GUILayout.Pressed = "Use These in This Project";
            Show(asset.Importer);
            Assert.That((Unity.Physics.gravity.y, Unity.Physics.defaultSolverIterations, Unity.Time.fixedDeltaTime), Is.EqualTo((-1.62f, 12, 0.01f)));
            Assert.That(asset.Root.GetComponent<KinefabMechanism>().Source, Is.SameAs(asset.Source));
        }
        finally
        {
            Unity.GUILayout.Pressed = null;
            (Unity.Physics.gravity, Unity.Physics.defaultSolverIterations, Unity.Time.fixedDeltaTime) = before;
        }
    }

    // The inspector may stay open while its file is exported anew or its settings are applied.
    [Test]
    public void Inspector_AfterAnotherImport_ShowsWhatThatOneFound()
    {
        using var scene = new EditedScene();
        var editor = Unity.ScriptableObject.CreateInstance<KinefabImporterEditor>();
        foreach ((double gravity, bool breaks) in new[] { (-9.81, false), (-1.62, true) })
        {
            scene.Save(json =>
            {
                json["physics"] = new JsonObject { ["gravity"] = new JsonArray(0, gravity, 0) };
                if (breaks)
                    scene.Objects.SelectMany(o => o!["components"]?.AsArray() ?? []).First(c => (string)c!["type"]! == "HingeJoint")!["breakForce"] = 12;
            });
            ImportedAsset asset = ImportedAsset.Of(scene.Scene, new KinefabSettings { physics = KinefabPhysics.Articulation });
            AssetDatabase.Assets[scene.Scene] = [.. asset.Context.Objects.Values];
            EditorGUILayout.Shown.Clear();
            editor.target = asset.Importer;
            editor.OnInspectorGUI();
            Assert.That(EditorGUILayout.Shown, Has.Some.Contains(System.FormattableString.Invariant($"gravity (0, {gravity}, 0)")));
            Assert.That(EditorGUILayout.Shown.Count(s => s.Contains("UNITY_PHYSICS_AS_EXPORTED", System.StringComparison.Ordinal)), Is.EqualTo(breaks ? 1 : 0));
        }
    }

    [Test]
    public void Inspector_OfAFaultyFile_ShowsItsErrors()
    {
        ImportedAsset asset = ImportedAsset.Of(Path.Combine(ConformanceCases.Folder, "invalid", "gameobject", "parent_later.kinefab"));
        Show(asset.Importer);
        Assert.That(EditorGUILayout.Shown.Single(s => s.StartsWith("Error: ", System.StringComparison.Ordinal)), Does.Contain("line").And.Contain("/gameObjects/"));
    }

    // Whatever is wrong with a file or a project: one sentence with what to do, in the inspector and in the import log.
    [TestCase("newer", "Error: VERSION_UNSUPPORTED", "2.0")]
    [TestCase("other", "Error: FORMAT_UNKNOWN", "kinefab.scene")]
    [TestCase("zip", "Error: FORMAT_MISSING", "kinefab export")]
    [TestCase("empty", "Error: SCENE_EMPTY", "")]
    [TestCase("buffer", "Error: BUFFER_MISSING", "lever")]
    [TestCase("shader", "Warning: UNITY_SHADER_MISSING", "Install the package")]
    [TestCase("breaks", "Warning: UNITY_PHYSICS_AS_EXPORTED", "As Exported")]
    [TestCase("locked", "Info: UNITY_NOTHING_MOVES", "kinefab analyse")]
    public void Inspector_OfBadInput_SaysWhatToDo(string what, string begins, string says)
    {
        using var scene = new EditedScene(what == "locked" ? "mechanisms/M45.kinefab" : "lever/lever.kinefab");
        Unity.Shader standard = Unity.Shader.Known["Standard"];
        switch (what)
        {
            case "newer": scene.Save(json => json["version"] = "2.0"); break;
            case "other": scene.Save(json => json["format"] = "of.another.program"); break;
            case "zip": File.WriteAllText(scene.Scene, "PK\u0003\u0004 not a scene at all"); break;
            case "empty": File.WriteAllText(scene.Scene, ""); break;
            case "buffer": File.Delete(Path.Combine(scene.Folder, (string)scene.Json["buffers"]![0]!["uri"]!)); break;
            case "shader": Unity.Shader.Known.Remove("Standard"); break;
            case "breaks": scene.Save(_ => scene.Objects.SelectMany(o => o!["components"]?.AsArray() ?? []).First(c => (string)c!["type"]! == "HingeJoint")!["breakForce"] = 12); break;
        }

        try
        {
            ImportedAsset asset = ImportedAsset.Of(scene.Scene, new KinefabSettings { physics = what == "breaks" ? KinefabPhysics.Articulation : KinefabPhysics.AsExported });
            AssetDatabase.Assets[scene.Scene] = [.. asset.Context.Objects.Values];
            Show(asset.Importer);
            Assert.That(EditorGUILayout.Shown.Single(s => s.StartsWith(begins, System.StringComparison.Ordinal)), Does.Contain(says));
            if (what != "locked")
                Assert.That(asset.Context.Errors.Concat(asset.Context.Warnings), Has.Some.Contains(begins.Split(' ')[1]), "the import log");
        }
        finally
        {
            Unity.Shader.Known["Standard"] = standard;
        }
    }

    [Test]
    public void Inspector_WithAMaterialGiven_RemapsIt()
    {
        using var scene = new EditedScene();
        ImportedAsset asset = ImportedAsset.Of(scene.Scene);
        AssetDatabase.Assets[scene.Scene] = [.. asset.Context.Objects.Values];
        string name = asset.Identifiers("materials").First()["materials/".Length..];
        var own = new Unity.Material(Unity.Shader.Find("Standard"));
        EditorGUILayout.Set = (label, value) => label == name ? own : value is false ? true : value!;
        Show(asset.Importer);
        Assert.That(asset.Importer.GetExternalObjectMap().Single().Value, Is.SameAs(own));
        Assert.That(asset.Importer.GetExternalObjectMap().Single().Key.name, Is.EqualTo(name));
    }

    private static void Show(KinefabImporter importer)
    {
        var editor = Unity.ScriptableObject.CreateInstance<KinefabImporterEditor>();
        editor.target = importer;
        editor.OnInspectorGUI();
        Assert.That(editor.IsClosed, Is.True, "Unity complains of an inspector that does not call ApplyRevertGUI");
    }
}
