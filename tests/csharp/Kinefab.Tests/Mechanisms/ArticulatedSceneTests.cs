using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.IO;
using System.Linq;
using System.Security.Cryptography;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Mechanisms;
using Kinefab.Numerics;
using Kinefab.Tests.Conformance;
using Kinefab.Tests.Dynamics.Rattle;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Mechanisms;

/// <summary>What becomes of a file's joints is what <c>kinefab export --physics articulation</c> writes of the same source.</summary>
public sealed class ArticulatedSceneTests
{
    private static readonly string Repository = Path.GetFullPath(Path.Combine(ConformanceCases.Folder, "..", ".."));
    private static readonly string Python = Path.Combine(Repository, ".venv", OperatingSystem.IsWindows() ? "Scripts/python.exe" : "bin/python");

    // KINEFAB_ARTICULATIONS sets another number of random machines.
    private static readonly string Machines = Environment.GetEnvironmentVariable("KINEFAB_ARTICULATIONS") ?? "60";

    // Counted in bytes, since each id that was tried is a text: they grow as the joints do.
    [Test]
    public void Of_ManyJointsWithoutIdsBetweenOnePair_GivesEachHelperANumberAtACostByTheJoints()
    {
        ValidScene?[] made = new ValidScene?[3];
        long[] bytes = new long[3];
        for (int i = 0; i < 3; i++)
        {
            // The first warms up.
            ValidScene scene = SceneValidator.Validate(HubScenes.Pair(i == 2 ? 2_000 : 500)).Scene!;
            long before = GC.GetAllocatedBytesForCurrentThread();
            made[i] = ArticulatedScene.Of(scene, out _);
            bytes[i] = GC.GetAllocatedBytesForCurrentThread() - before;
        }

        string[] ids = made[1]!.Document.GameObjects.Select(each => each.Id).Where(id => id.StartsWith("kinefab:helper", StringComparison.Ordinal)).ToArray();
        Assert.That(ids, Is.EqualTo(Enumerable.Range(1, 498).Select(n => n == 1 ? "kinefab:helper b1" : $"kinefab:helper b1#{n}")));
        Assert.That(bytes[2], Is.LessThan(5 * bytes[1]));
    }

    [Test]
    public void Of_FixturesAndRandomMachines_IsTheSceneExportedWithLinks()
    {
        string folder = Directory.CreateTempSubdirectory("kinefab-articulations-").FullName;
        try
        {
            Export(folder);
            List<string> apart = [];
            int links = 0, refused = 0, compared = 0;
            foreach (string file in Directory.GetFiles(folder, "*.joints.kinefab").Order(StringComparer.Ordinal))
            {
                string stem = file[..^".joints.kinefab".Length], name = Path.GetFileName(stem);
                ValidScene? made = ArticulatedScene.Of(ValidScene.Load(file), out Report report);
                if (!File.Exists(stem + ".links.kinefab"))
                {
                    refused++;
                    if (made is not null || report.Diagnostics.All(d => d.Code != DiagnosticCodes.ArticulationImpossible))
                        apart.Add($"{name}: the export says {File.ReadAllText(stem + ".refused")}");
                    continue;
                }

                links++;
                if (made is null)
                {
                    apart.Add($"{name}: {report}");
                    continue;
                }

                var comparison = new DocumentComparison(ValidScene.Load(stem + ".links.kinefab"), made);
                comparison.Same(name);
                compared += comparison.Compared;
                apart.AddRange(comparison.Apart);
            }

            TestContext.Out.WriteLine($"{links} scenes of links, {compared} fields, {refused} refused");
            Assert.That(string.Join("\n", apart), Is.Empty);
            Assert.That((links > 100, refused > 20, compared > 30_000), Is.EqualTo((true, true, true)));
        }
        finally
        {
            Directory.Delete(folder, recursive: true);
        }
    }

    [Test]
    public void Of_SceneWithLinks_IsTheScene()
    {
        ValidScene scene = Arm(), links = ArticulatedScene.Of(scene, out _)!;
        Assert.That(ArticulatedScene.Of(links, out Report report), Is.SameAs(links));
        Assert.That(report.Diagnostics, Is.Empty);
        ValidScene bare = SceneValidator.Validate(new SceneDocument { GameObjects = [new GameObject { Id = "Part", Name = "Part", Components = [new Rigidbody()] }] }).Scene!;
        Assert.That(ArticulatedScene.Of(bare, out _)!.Document.GameObjects[0].Components[0], Is.InstanceOf<Rigidbody>(), "what nothing holds is no link");
    }

    [Test]
    public void Of_GroundWithoutABody_HangsOnAGroundOfItsOwn()
    {
        GameObject[] objects =
        [
            new() { Id = "kinefab:ground", Name = "Ground" },
            new() { Id = "arm", Name = "arm", Components = [new Rigidbody(), new HingeJoint()] },
        ];
        ValidScene made = ArticulatedScene.Of(SceneValidator.Validate(new SceneDocument { GameObjects = objects }).Scene!, out _)!;
        Assert.That(made.Document.GameObjects.Count(o => o.Components.OfType<ArticulationBody>().Any()), Is.EqualTo(2));
    }

    // Unity works the connected anchor out: the file's own is nothing then.
    [Test]
    public void Of_AnchorThatUnityWorksOut_IsTheOwnOne()
    {
        ArticulationBody stated = Link(Arm(hinge => hinge with { AutoConfigureConnectedAnchor = false, ConnectedAnchor = new Vector3d(1, 2, 3) }));
        ArticulationBody found = Link(Arm(hinge => hinge with { AutoConfigureConnectedAnchor = true, ConnectedAnchor = new Vector3d(7, 7, 7) }));
        Assert.That(found, Is.EqualTo(stated with { Because = found.Because }));
    }

    [Test]
    public void Of_ScaledBodies_NamesTheJoint()
    {
        ValidScene? made = ArticulatedScene.Of(Arm(scale: 2), out Report report);
        Assert.That(made, Is.Null);
        Assert.That(report.Diagnostics.Select(d => (d.Code, d.Pointer)), Is.EqualTo([(DiagnosticCodes.ArticulationImpossible, "/gameObjects/1/components/1")]));
        Assert.That(report.Diagnostics[0].Message, Does.Contain("Arm").And.Contain("scaled"));
    }

    [Test]
    public void Of_MoreLinksThanPhysXHasRoomFor_SaysSo()
    {
        var objects = new List<GameObject> { Part(0) with { Components = [new Rigidbody { IsKinematic = true }] } };
        for (int i = 1; i < 70; i++)
            objects.Add(Part(i) with { Components = [new Rigidbody(), new HingeJoint { ConnectedBody = i - 1 }] });
        ValidScene made = ArticulatedScene.Of(SceneValidator.Validate(new SceneDocument { GameObjects = objects }).Scene!, out Report report)!;
        Assert.That(made.Document.GameObjects.Count(o => o.Components[0] is ArticulationBody), Is.EqualTo(70));
        Assert.That(report.Diagnostics.Single().Message, Does.Contain("begins with Part0 has 70 links"));

        static GameObject Part(int i) => new() { Id = $"Part{i}", Name = $"Part {i}", Transform = new Transform { LocalPosition = new Vector3d(i, 0, 0) } };
    }

    // A triangle has no hull; a tetrahedron is its own. Neither is taken on a link as it is.
    [TestCase(3, typeof(BoxCollider), "COLLIDER_FLAT_AS_BOX")]
    [TestCase(4, typeof(MeshCollider), "COLLIDER_MESH_AS_HULL")]
    public void Of_MeshThatIsNotConvex_OnALink_IsMadeConvex(int corners, Type kind, string code)
    {
        float[] points = [0, 0, 0, 1, 0, 0, 0, 2, 0, 0.1f, 0.1f, 3];
        byte[] bytes = [.. points.Take(3 * corners).SelectMany(BitConverter.GetBytes), .. new ushort[] { 0, 1, 2 }.SelectMany(BitConverter.GetBytes)];
        var mesh = new Mesh
        {
            Name = "Sheet",
            VertexCount = corners,
            Positions = new Accessor { Offset = 0 },
            Indices = new Accessor { Offset = 12 * corners },
            Submeshes = [new Submesh { IndexCount = 3 }],
            Bounds = new Bounds { Center = new Vector3d(0.5, 1, corners == 3 ? 0 : 1.5), Extents = new Vector3d(0.5, 1, corners == 3 ? 0 : 1.5) },
        };
        SceneDocument arm = Arm().Document;
        GameObject[] objects = [.. arm.GameObjects];
        objects[1] = objects[1] with { Components = [.. objects[1].Components, new MeshCollider { Mesh = 0, Group = "G", Id = "Sheet" }] };
        SceneValidation valid = SceneValidator.Validate(arm with { GameObjects = objects, Meshes = [mesh], Buffers = [new SceneBuffer { ByteLength = bytes.Length, Data = bytes, Sha256 = Convert.ToHexStringLower(SHA256.HashData(bytes)) }] });
        Assert.That(valid.Report.HasErrors, Is.False, string.Join("\n", valid.Report.Diagnostics));
        ValidScene made = ArticulatedScene.Of(valid.Scene!, out Report report)!;
        Component collider = made.Document.GameObjects[1].Components[1];
        Assert.That(collider, Is.InstanceOf(kind));
        Assert.That(report.Diagnostics.Select(d => d.Code), Is.EqualTo([code]));
        Assert.That(collider is MeshCollider { Convex: true, Group: "G" } or BoxCollider { Size: { X: 1, Y: 2, Z: 0 }, Group: "G" });
    }

    // The source's world and the couplings follow; what is switched off holds nothing, and what follows it is told.
    [Test]
    public void Of_CouplingsOfSwitchedOffJoints_AreLeftOutAndTold()
    {
        ValidScene scene = ValidScene.Load(Path.Combine(ConformanceCases.Folder, "valid", "hinge", "switched_off.kinefab"));
        ValidScene made = ArticulatedScene.Of(scene, out Report report)!;
        Assert.That(report.Diagnostics.Count(d => d.Code == DiagnosticCodes.JointDisabledDropped), Is.EqualTo(2));
        Assert.That(report.Diagnostics.Count(d => d.Code == DiagnosticCodes.CouplingWithoutJoint), Is.EqualTo(scene.Document.Couplings.Count - made.Document.Couplings.Count).And.GreaterThan(0));
    }

    private static ValidScene Arm(Func<HingeJoint, HingeJoint>? change = null, double scale = 1)
    {
        var hinge = new HingeJoint { ConnectedBody = 0, Anchor = new Vector3d(0, 0, 0), Axis = new Vector3d(0, 0, 1) };
        var body = new Rigidbody();
        var place = new Transform { LocalPosition = new Vector3d(1, 2, 3), LocalRotation = Quaterniond.AxisAngle(Vector3d.UnitY, 0.7), LocalScale = new Vector3d(scale, scale, scale) };
        GameObject[] objects =
        [
            new() { Id = "Base", Name = "Base", Components = [new Rigidbody { IsKinematic = true }] },
            new() { Id = "Arm", Name = "Arm", Transform = place, Components = [body, change?.Invoke(hinge) ?? hinge] },
        ];
        return SceneValidator.Validate(new SceneDocument { GameObjects = objects }).Scene!;
    }

    private static ArticulationBody Link(ValidScene scene) => (ArticulationBody)ArticulatedScene.Of(scene, out _)!.Document.GameObjects[1].Components[0];

    private static void Export(string folder)
    {
        if (!File.Exists(Python))
            Assert.Ignore("the Python half is not set up (make setup)");
        using var done = Process.Start(new ProcessStartInfo(Python, [Path.Combine(Repository, "tests", "python", "articulations.py"), folder, Machines]) { RedirectStandardError = true })!;
        string said = done.StandardError.ReadToEnd();
        done.WaitForExit();
        Assert.That(done.ExitCode, Is.Zero, said);
    }
}
