using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.IO;
using System.Linq;
using Kinefab.Tests.Conformance;
using Kinefab.Validation;
using KinefabUnity;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>
/// Two programs, one result, field by field: what the package makes of a scene is what Python's exporter writes as a prefab, and each field of
/// the document that C# reads stands in it. So what the prefab has, the document has.
/// </summary>
[NonParallelizable]
public sealed class PrefabTests
{
    private static readonly string Repository = Path.GetFullPath(Path.Combine(ConformanceCases.Folder, "..", ".."));
    private static readonly string Python = Path.Combine(Repository, ".venv", OperatingSystem.IsWindows() ? "Scripts/python.exe" : "bin/python");
    private string folder = "";

    [SetUp]
    public void MakeFolder()
    {
        folder = Directory.CreateTempSubdirectory("kinefab-prefabs-").FullName;
        Unity.LayerMask.Layers.Add("Scenery"); // as prefabs.py makes the project
        Unity.GameObject.Tags.Add("Ground");
    }

    [TearDown]
    public void Remove()
    {
        Directory.Delete(folder, recursive: true);
        Unity.LayerMask.Layers.Remove("Scenery");
        Unity.GameObject.Tags.Remove("Ground");
    }

    [TestCase("body", 80)]
    [TestCase("world", 80)]
    [TestCase("links", 50)]
    [TestCase("asked", 90)]
    [TestCase("clips", 1)]
    [TestCase("builtin", 1)]
    [TestCase("urp", 1)]
    [TestCase("hdrp", 1)]
    public void Import_EveryFixture_IsThePrefabOfTheSameExport(string kind, int least)
    {
        using RenderPipelines pipeline = RenderPipelines.Use(kind);
        Export(kind);
        string[] prefabs = [.. Directory.GetFiles(folder, "*.prefab", SearchOption.AllDirectories).Order(StringComparer.Ordinal)];
        Assert.That(prefabs, Has.Length.AtLeast(least));
        List<string> apart = [];
        int compared = 0;
        var document = new FieldComparison();
        foreach (string prefab in prefabs)
        {
            var comparison = new PrefabComparison(prefab);
            ImportedAsset asset = ImportedAsset.Of(Path.ChangeExtension(prefab, ".kinefab"), kind == "asked" ? new KinefabSettings { physics = KinefabPhysics.Articulation } : null);
            Assert.That(asset.Context.Errors, Is.Empty, prefab);
            try
            {
                using (new global::NUnit.Framework.Internal.TestExecutionContext.IsolatedContext())
                {
                    comparison.Same(asset.Root);
                    UnityImportTests.Compare(ValidScene.Load(Path.ChangeExtension(prefab, ".kinefab")), document);
                }
            }
            catch (AssertionException fault)
            {
                apart.Add($"{Path.GetFileName(Path.GetDirectoryName(prefab))}: {fault.Message}");
            }

            compared += comparison.Compared;
        }

        Assert.That(apart, Is.Empty);
        TestContext.Out.WriteLine($"{prefabs.Length} prefabs, {compared} fields of theirs, {document.Compared} of documents");
        Assert.That(compared, Is.GreaterThan(100 * prefabs.Length));
        Assert.That(document.Compared, Is.GreaterThan(50 * prefabs.Length));
    }

    private void Export(string kind)
    {
        if (!File.Exists(Python))
            Assert.Ignore("the Python half is not set up (make setup)");
        using var done = Process.Start(new ProcessStartInfo(Python, [Path.Combine(Repository, "tests", "python", "prefabs.py"), folder, kind]) { RedirectStandardError = true })!;
        string said = done.StandardError.ReadToEnd();
        done.WaitForExit();
        Assert.That(done.ExitCode, Is.Zero, said);
    }
}
