using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using Kinefab.Dynamics.Articulations;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Articulations;

/// <summary>Articulations against PhysX 5.6.1, by its rules (tests/reference/articulations).</summary>
public sealed class ArticulationPhysXTests
{
    private const double Tolerance = 1e-4;

    private static readonly string Folder = Path.Combine(Scenario.Folder, "articulations");

    private static readonly IReadOnlyList<ReferenceArticulation> All = ReferenceArticulation.Read(Path.Combine(Folder, "traces.json"));

    private static IEnumerable<string> Names => All.Select(s => s.Name);

    [TestCaseSource(nameof(Names))]
    public void Step_Scenario_FollowsPhysX(string name)
    {
        (double metres, double radians) = Compare(All.Single(s => s.Name == name));
        using (Assert.EnterMultipleScope())
        {
            Assert.That(metres, Is.LessThanOrEqualTo(Tolerance), "metres");
            Assert.That(radians, Is.LessThanOrEqualTo(Tolerance), "radians");
        }
    }

    [Test]
    public void Scenarios_Range_AreManyAndMove()
    {
        string[] still = [.. All.Where(s => s.Name != "fixed-hangs" && s.Name != "prismatic-limits" && Way(s) < 10 * Tolerance).Select(s => s.Name)];
        using (Assert.EnterMultipleScope())
        {
            Assert.That(All, Has.Count.GreaterThanOrEqualTo(60));
            Assert.That(still, Is.Empty);
        }
    }

    [Test]
    public void Document_TableOfArticulations_NamesEveryScenario()
    {
        string path = Path.Combine(Folder, "COMPARISON.md");
        if (Environment.GetEnvironmentVariable("KINEFAB_WRITE_TABLES") == "1")
            File.WriteAllText(path, Table());
        string[] rows = [.. File.ReadAllLines(path).Where(l => l.StartsWith("| `", StringComparison.Ordinal))];
        Assert.That(rows.Select(r => r.Split('`')[1]), Is.EqualTo(Names));
    }

    /// <summary>npm run articulations:fuzz writes random trees with PhysX's first step of each.</summary>
    [Test]
    public void FirstStep_OfRandomTrees_IsPhysXs()
    {
        string path = Path.Combine(Scenario.Folder, "out", "articulations.json");
        if (!File.Exists(path))
            Assert.Ignore("npm run fuzz:articulations, in tests/reference, writes " + path);
        IReadOnlyList<ReferenceArticulation> trees = ReferenceArticulation.Read(path);
        string[] faults = [.. trees.Select(t => (t.Name, Difference: t.Compare())).Where(t => !(t.Difference.Metres < Tolerance && t.Difference.Radians < Tolerance)).Select(t => $"{t.Name}: {t.Difference}")];
        TestContext.Out.WriteLine($"{trees.Count} trees, worst {trees.Max(t => t.Compare().Metres):0.0e+00} m");
        Assert.That(faults, Is.Empty);
    }

    private static (double Metres, double Radians) Compare(ReferenceArticulation scenario) => scenario.HasJoints ? MixedSystem.Compare(scenario) : scenario.Compare();

    private static double Way(ReferenceArticulation scenario)
    {
        int last = scenario.Steps / scenario.Sample - 1;
        return Enumerable.Range(0, scenario.MakeTree().Count).Max(i =>
            Enumerable.Range(0, last + 1).Max(k =>
            {
                Pose there = scenario.Reference(i, k), start = scenario.ReferenceStart(i);
                return (there.Position - start.Position).Length + TreeKinematics.RotationVector(there.Rotation * start.Rotation.Conjugate()).Length;
            }));
    }

    private static string Table()
    {
        var text = new StringBuilder();
        text.Append("# Articulations against PhysX 5.6.1\n\n");
        text.Append("Generated: `KINEFAB_WRITE_TABLES=1 dotnet test csharp/Kinefab.slnx --filter Name=Document_TableOfArticulations_NamesEveryScenario`.\n");
        text.Append("Largest difference of any body's centre of mass and rotation from PhysX's, over 100 steps of 0.02 s. The test fails above\n");
        text.Append("1e-4 m or 1e-4 rad. The rules are those of 5.6.1 (`ArticulationRules.PhysX5`), since 4.1 cannot be run outside Unity with\n");
        text.Append("articulations; Unity's own, which a `World` has, part from them where `ArticulationRules` says, by the public sources of\n");
        text.Append("both. How the traces are made: [README](../README.md#articulations).\n\n");
        text.Append("| scenario | what | m | rad |\n|---|---|---|---|\n");
        foreach (ReferenceArticulation s in All)
        {
            (double metres, double radians) = Compare(s);
            text.Append(CultureInfo.InvariantCulture, $"| `{s.Name}` | {s.About} | {metres:0.0e-0} | {radians:0.0e-0} |\n");
        }

        return text.ToString();
    }
}
