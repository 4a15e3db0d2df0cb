using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using KinefabUnity;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>
/// A file that is exported anew while an object of it stands in an open scene. Unity then writes into the components that are there, and
/// what is not serialized stays in them.
/// </summary>
[NonParallelizable]
public sealed class MechanismReimportTests
{
    private const BindingFlags Own = BindingFlags.Instance | BindingFlags.NonPublic;

    // Metres: of single precision beside parts of some decimetres.
    private const double Single = 2e-6;

    [TestCase(false)]
    [TestCase(true)]
    public void Instance_InAnOpenScene_MovesAsTheNewFileDoes(bool plays)
    {
        using var scene = new EditedScene(PlayedMechanism.Lever);
        Unity.Player.Play(plays);
        try
        {
            KinefabMechanism standing = Instance(scene), fresh;
            standing.Drive("Shaft", 30);
            scene.Reorder(i => -i);
            ImportedAsset anew = ImportedAsset.Of(scene.Scene);
            TakeOver(anew.Root.GetComponent<KinefabMechanism>(), standing);
            Assert.That(standing.Value("Shaft"), Is.EqualTo(30).Within(1e-9), "the pose is the instance's own");

            fresh = Instance(scene);
            Assert.That((standing.Drive("Shaft", 75).Reached, fresh.Drive("Shaft", 75).Reached), Is.EqualTo((true, true)));
            Place(standing);
            Place(fresh);
            Dictionary<string, Unity.Vector3> there = Positions(fresh);
            foreach ((string part, Unity.Vector3 at) in Positions(standing))
                Assert.That(Unity.Vector3.Distance(at, there[part]), Is.LessThan(Single), part);
            Unity.Object.DestroyImmediate(standing.gameObject);
            Unity.Object.DestroyImmediate(fresh.gameObject);
        }
        finally
        {
            Unity.Player.Play(false);
        }
    }

    [Test]
    public void Object_OfAnUnpackedPrefab_SaysThatItIsOfTheFileBefore()
    {
        using var scene = new EditedScene(PlayedMechanism.Lever);
        KinefabMechanism standing = Instance(scene);
        FieldInfo source = Field("source");
        object before = source.GetValue(standing)!;
        standing.Drive("Shaft", 30);
        scene.Save(json => json["gameObjects"]!.AsArray().Add(new System.Text.Json.Nodes.JsonObject { ["id"] = "added", ["name"] = "Added" }));
        source.SetValue(standing, ImportedAsset.Of(scene.Scene).Source);
        Assert.That(standing.Drive("Shaft", 60).Stop, Is.EqualTo(KinefabStop.NoMechanism));
        Assert.That(standing.Problem, Does.Contain("other parts or joints"));

        // The file as it was comes back, and the fault goes.
        source.SetValue(standing, before);
        Assert.That(standing.Drive("Shaft", 60).Reached, Is.True);
        Assert.That(standing.Problem, Is.Empty);
        Unity.Object.DestroyImmediate(standing.gameObject);
    }

    // Unity calls a method of such a name for reasons of its own: Reset when a component is added.
    [Test]
    public void StaticMethods_OfComponents_HaveNoNameOfAMessage()
    {
        string[] messages = ["Awake", "Start", "Reset", "OnEnable", "OnDisable", "OnDestroy", "OnValidate", "Update", "FixedUpdate", "LateUpdate"];
        Type[] components = [.. typeof(KinefabMechanism).Assembly.GetTypes().Where(typeof(Unity.MonoBehaviour).IsAssignableFrom)];
        Assert.That(components.SelectMany(type => type.GetMethods(BindingFlags.Static | BindingFlags.NonPublic | BindingFlags.Public)).Select(method => method.Name), Has.None.AnyOf(messages));
    }

    private static KinefabMechanism Instance(EditedScene scene) => Unity.Object.Instantiate(ImportedAsset.Of(scene.Scene).Root).GetComponent<KinefabMechanism>();

    // What Unity does of a prefab's instance: the prefab's values, references turned to the instance's own objects, but not what the instance overrides.
    private static void TakeOver(KinefabMechanism prefab, KinefabMechanism instance)
    {
        ((Unity.ISerializationCallbackReceiver)instance).OnBeforeSerialize();
        foreach (string field in new[] { "source", "freedoms", "carriers", "islands", "problem" })
            Field(field).SetValue(instance, Field(field).GetValue(prefab));
        Dictionary<string, Unity.Transform> own = instance.GetComponentsInChildren<Unity.Transform>(true).ToDictionary(at => Path(at, instance.transform));
        var parts = (Unity.Transform[])Field("parts").GetValue(prefab)!;
        Field("parts").SetValue(instance, Array.ConvertAll(parts, part => own[Path(part, prefab.transform)]));
        ((Unity.ISerializationCallbackReceiver)instance).OnAfterDeserialize();
        Unity.Calls.Of(instance, "OnValidate");
    }

    // In play bodies arrive with the physics step.
    private static void Place(KinefabMechanism of)
    {
        Unity.Player.Frame();
        foreach (Unity.Rigidbody body in of.GetComponentsInChildren<Unity.Rigidbody>())
            body.Arrive();
    }

    private static Dictionary<string, Unity.Vector3> Positions(KinefabMechanism of) =>
        of.GetComponentsInChildren<Unity.Transform>(true).ToDictionary(at => Path(at, of.transform), at => at.position);

    private static string Path(Unity.Transform at, Unity.Transform root) => at == root ? "" : $"{Path(at.parent, root)}/{at.name}";

    private static FieldInfo Field(string name) => typeof(KinefabMechanism).GetField(name, Own)!;
}
