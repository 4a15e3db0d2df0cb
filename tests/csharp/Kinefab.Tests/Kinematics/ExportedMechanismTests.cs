using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Tests.Conformance;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>
/// The scenes that the exporter makes of the mechanisms under fixtures: the mobility counted here against the one counted
/// from the constraints, and motions against their closed forms, read back in the source's right-handed frame.
/// </summary>
public class ExportedMechanismTests
{
    private static IEnumerable<TestCaseData> Scenes() => Directory.GetFiles(ExportedMechanism.Fixtures, "*.kinefab", SearchOption.AllDirectories)
        .Order(StringComparer.Ordinal)
        .Select(path => new TestCaseData(path).SetArgDisplayNames(Path.GetFileNameWithoutExtension(path)));

    [TestCaseSource(nameof(Scenes))]
    public void Mobility_OfTheJoints_IsThatOfTheConstraints(string path)
    {
        ValidScene scene = ExportedMechanism.Load(path);
        Report report = MobilityCheck.Compare(scene, MobilityAnalysis.Of(Mechanism.Create(scene)));
        Assert.That(report.Diagnostics.Where(d => d.Severity == Severity.Error).Select(d => d.ToString()), Is.Empty);
    }

    // The table's numbers are those of the literature, not of the exporter.
    [TestCaseSource(nameof(Table))]
    public void Mobility_OfTheJoints_IsThatOfTheTable(string id, int firstOrder, int finite, string[] freedoms)
    {
        var exported = new ExportedMechanism(id);
        MobilityReport counted = MobilityAnalysis.Of(exported.Mechanism);
        Assert.That((counted.FirstOrder, counted.Mobility), Is.EqualTo((firstOrder, finite)));
        foreach (string[] freedom in freedoms.Select(f => f.Split('=')))
        {
            // "lo" stands for lo1, lo_x and so on.
            string[] ids = exported.Scene.Document.GameObjects.Select(o => o.Id).ToArray();
            int[] parts = Enumerable.Range(0, ids.Length)
                .Where(i => ids.Contains(freedom[0]) ? ids[i] == freedom[0] : ids[i].StartsWith(freedom[0], StringComparison.Ordinal)).ToArray();
            Assert.That(parts, Is.Not.Empty);
            foreach (int part in parts)
            {
                BodyMobility? found = counted.Bodies.SingleOrDefault(b => b.GameObject == exported.Scene.BodyOf(part));
                Assert.That((found?.Translations ?? 0) + (found?.Rotations ?? 0), Is.EqualTo(Number(freedom[1])), freedom[0]);
            }
        }
    }

    private static IEnumerable<TestCaseData> Table() => File
        .ReadAllLines(Path.Combine(ConformanceCases.Folder, "..", "python", "data", "mechanisms", "mobility.csv"))
        .Where(line => line.StartsWith('M'))
        .Select(line => line.Split(','))
        .Select(row => new TestCaseData(row[0], Number(row[^4]), Number(row[^2]), row[^1].Split(' ', StringSplitOptions.RemoveEmptyEntries))
            .SetArgDisplayNames(row[0]));

    private static int Number(string text) => int.Parse(text, CultureInfo.InvariantCulture);

    // A four-bar of four hinges: mobility 1, three rows of the closing one redundant.
    [TestCase("/analysis/mobility", "is 9 in the file", "1 counted from the joints")]
    [TestCase("/analysis/idle", "is 9 in the file", "0 counted from the joints")]
    [TestCase("/analysis/redundant", "is 2 in the file", "3 counted from the joints")]
    [TestCase("/analysis/islands/0/mobility", "is 9 in the file", "1 counted from the joints")]
    [TestCase("/analysis/islands/0/redundant", "is 2 in the file", "3 counted from the joints")]
    [TestCase("/analysis/islands/0/loops", "is 9 in the file", "1 counted from the joints")]
    [TestCase("/analysis/bodies/0/rotations", "is 9 in the file", "1 counted from the joints")]
    public void Mobility_AnotherNumberInTheFile_IsAnErrorWithBoth(string place, string stated, string counted)
    {
        int Wrong(string at, int right) => at != place ? right : at.EndsWith("redundant", StringComparison.Ordinal) ? 2 : 9;
        var bar = new FourBar(0.4, 1.2, 0.8, 1, 25);
        bar.Scene.Analysis = new Analysis
        {
            Mobility = Wrong("/analysis/mobility", 1),
            Idle = Wrong("/analysis/idle", 0),
            Redundant = Wrong("/analysis/redundant", 3),
            Islands =
            [
                new Island
                {
                    GameObjects = [0, 1, 2],
                    Mobility = Wrong("/analysis/islands/0/mobility", 1),
                    Redundant = Wrong("/analysis/islands/0/redundant", 3),
                    Loops = Wrong("/analysis/islands/0/loops", 1),
                },
            ],
            Bodies = [new BodyFreedom { GameObject = 0, Rotations = Wrong("/analysis/bodies/0/rotations", 1) }],
        };
        var valid = new ValidScene(bar.Scene.Document());
        Diagnostic found = MobilityCheck.Compare(valid, MobilityAnalysis.Of(Mechanism.Create(valid))).Diagnostics.Single();
        Assert.That((found.Code, found.Pointer, found.Severity), Is.EqualTo((DiagnosticCodes.MobilityDiffers, place, Severity.Error)));
        Assert.That(found.Message, Does.Contain(stated).And.Contain(counted));
    }

    // Fewer redundant rows than the constraints had are what a minimal closure is for.
    [Test]
    public void Mobility_FewerRedundantRowsThanInTheFile_AreNoFinding()
    {
        var bar = new FourBar(0.4, 1.2, 0.8, 1, 25);
        bar.Scene.Analysis = new Analysis { Mobility = 1, Redundant = 7 };
        var valid = new ValidScene(bar.Scene.Document());
        Assert.That(MobilityCheck.Compare(valid, MobilityAnalysis.Of(Mechanism.Create(valid))).Diagnostics, Is.Empty);
    }

    [Test]
    public void Mobility_RodsBetweenBalls_SpinIdly()
    {
        MobilityReport counted = MobilityAnalysis.Of(SpatialMechanisms.Delta(withBalls: true).Scene.Mechanism());
        Assert.That(counted.Idle.Select(i => (i.GameObjects.Count, i.Count)), Is.EqualTo(Enumerable.Repeat((1, 1), 6)));
        Assert.That(MobilityAnalysis.Of(SpatialMechanisms.Arm().Scene.Mechanism()).Idle, Is.Empty, "an arm's last link is no leg");
    }

    [Test]
    public void Gears_ExportedAndDrivenTenTurns_TurnByTheTeeth()
    {
        var driven = new ExportedMechanism("M25");
        driven.Drive("g1", Coordinate.Angle, 3600);
        Assert.That(driven.Value("g2", Coordinate.Angle), Is.EqualTo(-1440).Within(1e-9));
    }

    // The minimal closure reads angles that mean nothing at a half turn; the mechanism itself moves on as before.
    [Test]
    public void Parallelogram_ExportedAndSweptThroughItsFlatPoses_ReportsNoJump()
    {
        var driven = new ExportedMechanism("M04");
        SweepResult swept = driven.Sweep("crank", 360, 12);
        Assert.That(swept.Stop, Is.Null);
        Assert.That(swept.Jumps, Is.Empty);
    }
}
