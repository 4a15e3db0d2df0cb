using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Tests.Conformance;
using Kinefab.Validation;
using KinefabUnity;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>
/// What the Unity package makes of a scene, against stand-ins that hold Unity's members and refuse or lose what Unity
/// does when it is set in the wrong order.
/// </summary>
[NonParallelizable]
public sealed class UnityImportTests
{
    private static readonly string Fixtures = Path.Combine(ConformanceCases.Folder, "..", "..", "fixtures");

    private static IEnumerable<string> Scenes() => Directory.GetFiles(Fixtures, "*.kinefab", SearchOption.AllDirectories)
        .Concat(ConformanceCases.All.Where(c => c.Kind == "scene" && c.Path.StartsWith("valid/", StringComparison.Ordinal)).Select(c => c.FullPath))
        .Select(path => Path.GetRelativePath(Path.Combine(Fixtures, ".."), path)).Order(StringComparer.Ordinal);

    [TestCaseSource(nameof(Scenes))]
    public void Import_Scene_HasEveryObjectAndEveryFieldOfItsComponents(string path) =>
        Compare(ValidScene.Load(Path.Combine(Fixtures, "..", path)), new FieldComparison());

    // So that no field is the same in file and Unity only because both stand at the default.
    [Test]
    public void Import_EveryFieldAwayFromItsDefault_CarriesItOver()
    {
        var comparison = new FieldComparison();
        Compare(UnityImportScene.EveryField(), comparison);
        Assert.That(comparison.AtDefaults, Is.Empty);
    }

    [TestCase("fixtures/lever/lever.kinefab")]
    [TestCase("tests/conformance/valid/mesh/uint16.kinefab")]
    [TestCase("tests/conformance/valid/mesh/uint32.kinefab")]
    public void Import_Meshes_AreThoseOfTheBufferAndMaterialsAreShared(string path)
    {
        ValidScene scene = ValidScene.Load(Path.Combine(Fixtures, "..", path));
        Unity.GameObject[] objects = Import(scene);
        int shown = 0;
        for (int i = 0; i < objects.Length; i++)
        {
            foreach (MeshFilter filter in scene.Document.GameObjects[i].Components.OfType<MeshFilter>())
            {
                Unity.Mesh mesh = objects[i].GetComponent<Unity.MeshFilter>().sharedMesh;
                MeshData data = scene.Mesh(filter.Mesh);
                int[] indices = data.Mesh.IndexFormat == IndexFormat.UInt16 ? data.Indices16.ToArray().Select(n => (int)n).ToArray() : data.Indices32.ToArray().Select(n => (int)n).ToArray();
                Assert.That((mesh.name, (int)mesh.indexFormat, mesh.subMeshCount), Is.EqualTo((data.Mesh.Name, (int)data.Mesh.IndexFormat, data.Mesh.Submeshes.Count)));
                Assert.That(mesh.uv.SelectMany(v => new[] { v.x, v.y }), Is.EqualTo(data.Uv.ToArray()));
                Assert.That(mesh.vertices.SelectMany(v => new[] { v.x, v.y, v.z }), Is.EqualTo(data.Positions.ToArray()));
                Assert.That(mesh.normals.SelectMany(v => new[] { v.x, v.y, v.z }), data.Normals.IsEmpty ? Has.Exactly(3 * mesh.vertices.Length).Items : Is.EqualTo(data.Normals.ToArray()));
                Assert.That(Enumerable.Range(0, mesh.subMeshCount).SelectMany(mesh.GetTriangles), Is.EqualTo(indices));
                shown++;
            }
        }

        Unity.Material[] materials = objects.Select(o => o.GetComponent<Unity.MeshRenderer>()).Where(r => r is not null).SelectMany(r => r.sharedMaterials).ToArray();
        Assert.That(shown, Is.Positive);
        Assert.That(materials.Distinct().Select(m => m.name), Is.Unique.And.SubsetOf(scene.Document.Materials.Select(m => m.Name)));
    }

    [Test]
    public void Import_Material_TurnsLinearColourIntoUnitysAndKeepsTheRest()
    {
        ValidScene scene = ValidScene.Load(Path.Combine(ConformanceCases.Folder, "valid", "mesh", "uint32.kinefab"));
        int at = Enumerable.Range(0, scene.Document.GameObjects.Count).First(i => scene.Document.GameObjects[i].Components.OfType<MeshRenderer>().Any(r => r.Materials.Count > 0));
        Material from = scene.Document.Materials[scene.Document.GameObjects[at].Components.OfType<MeshRenderer>().Single().Materials[0]];

        Unity.Material to = Import(scene)[at].GetComponent<Unity.MeshRenderer>().sharedMaterials[0];

        // sRGB (IEC 61966-2-1).
        static double Srgb(double c) => c <= 0.0031308 ? 12.92 * c : 1.055 * Math.Pow(c, 1 / 2.4) - 0.055;
        Assert.That(new double[] { to.color.r, to.color.g, to.color.b, to.color.a }, Is.EqualTo(new[] { Srgb(from.Color.R), Srgb(from.Color.G), Srgb(from.Color.B), from.Color.A }).Within(1e-6));
        Assert.That((to.name, to.GetFloat("_Metallic"), to.GetFloat("_Glossiness")), Is.EqualTo((from.Name, (float)from.Metallic, (float)from.Smoothness)));
    }

    [Test]
    public void Import_UnderAParent_HangsTheRootsThere()
    {
        var parent = new Unity.GameObject("parent");
        Unity.GameObject[] objects = Import(ValidScene.Load(Path.Combine(Fixtures, "lever", "lever.kinefab")), parent.transform);
        Assert.That(objects[0].transform.parent, Is.SameAs(parent.transform));
    }

    [Test]
    public void ApplyProjectSettings_Scene_SetsTheProject()
    {
        KinefabSource.Of("""
            {"format": "kinefab.scene", "version": "1.0", "gameObjects": [], "physics": {"gravity": [0.5, -1.62, 0.25], "fixedTimestep": 0.01,
             "solverIterations": 12, "solverVelocityIterations": 3, "bounceThreshold": 3, "defaultMaxAngularSpeed": 9}}
            """u8.ToArray(), new KinefabSettings()).ApplyProjectSettings();
        Unity.Vector3 gravity = Unity.Physics.gravity;
        Assert.That((gravity.x, gravity.y, gravity.z), Is.EqualTo((0.5f, -1.62f, 0.25f)));
        Assert.That((Unity.Physics.bounceThreshold, Unity.Physics.defaultMaxAngularSpeed, Unity.Time.fixedDeltaTime), Is.EqualTo((3f, 9f, 0.01f)));
        Assert.That((Unity.Physics.defaultSolverIterations, Unity.Physics.defaultSolverVelocityIterations), Is.EqualTo((12, 3)));
    }

    [Test]
    public void Import_JointsSwitchedOff_AreLeftOutAndTold()
    {
        var findings = new List<KinefabFinding>();
        var builder = new SceneBuilder(ValidScene.Load(Path.Combine(ConformanceCases.Folder, "valid", "hinge", "switched_off.kinefab")), new KinefabSettings(), findings);
        builder.Build("Scene", null!);

        Assert.That(builder.Objects[1].Components.OfType<Unity.Joint>().Count(), Is.EqualTo(1));
        Assert.That(findings.Where(f => f.code == "JOINT_DISABLED_DROPPED").Select(f => f.message), Is.EqualTo([
            "Joint Latch:2 is switched off, and Unity has no place for such a joint; it is left out.",
            "Joint Latch:1 is switched off, and Unity has no place for such a joint; it is left out.",
        ]));
        Assert.That(findings.Where(f => f.code.StartsWith("UNITY_COUPLING", StringComparison.Ordinal) || f.code == "COUPLING_WITHOUT_JOINT").Select(f => f.code), Is.EqualTo(["COUPLING_WITHOUT_JOINT"]));
    }

    private static Unity.GameObject[] Import(ValidScene scene, Unity.Transform? parent = null)
    {
        var builder = new SceneBuilder(scene, new KinefabSettings(), []);
        builder.Build("Scene", parent!);
        return builder.Objects;
    }

    /// <summary>Asserts that every field of the document's objects and components stands in what is imported.</summary>
    internal static void Compare(ValidScene scene, FieldComparison comparison)
    {
        Unity.GameObject[] objects = Import(scene);
        comparison.Begin(scene, objects);
        Assert.That(objects, Has.Length.EqualTo(scene.Document.GameObjects.Count));
        for (int i = 0; i < objects.Length; i++)
        {
            GameObject from = scene.Document.GameObjects[i];
            Unity.GameObject to = objects[i];
            Assert.That((to.name.Split('~')[0], to.activeSelf), Is.EqualTo((ObjectNames.Plain(from.Name).Split('~')[0], from.Active)));
            if (from.Parent is int parent)
                Assert.That(to.transform.parent, Is.SameAs(objects[parent].transform));
            Assert.That(to.Components.OfType<Unity.Rigidbody>().Any(b => b.MovedAfterMade), Is.False, "PhysX would have made it at another place");
            comparison.Same(from.Transform, to.transform, from.Id);

            // The transform comes first, then the body; all else stands in the file's order, colliders without size and joints that are switched off left out.
            Component[] expected = [.. from.Components.Where(c => c is Rigidbody or ArticulationBody), .. from.Components.Where(c => c is not (Rigidbody or ArticulationBody or Collider or Joint { Enabled: false }) || (c is Collider collider && !ColliderFields.IsEmpty(collider)))];
            Unity.Component[] made = [.. to.Components.Skip(1).Where(c => c is not (KinefabBody or KinefabCoupling or Unity.Animation))];
            Assert.That(made.Select(c => c.GetType().Name), Is.EqualTo(expected.Select(c => c.GetType().Name)));
            for (int c = 0; c < expected.Length; c++)
                comparison.Same(expected[c], made[c], $"{from.Id} {expected[c].GetType().Name}");
        }
    }
}
