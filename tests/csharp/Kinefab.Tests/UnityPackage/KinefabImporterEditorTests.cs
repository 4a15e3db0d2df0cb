using System.IO;
using System.Linq;
using Kinefab.Tests.Conformance;
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

    [Test]
    public void Inspector_OfAFaultyFile_ShowsItsErrors()
    {
        ImportedAsset asset = ImportedAsset.Of(Path.Combine(ConformanceCases.Folder, "invalid", "gameobject", "parent_later.kinefab"));
        Show(asset.Importer);
        Assert.That(EditorGUILayout.Shown.Single(s => s.StartsWith("Error: ", System.StringComparison.Ordinal)), Does.Contain("line").And.Contain("/gameObjects/"));
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
