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
        Assert.That(counted.AtGeneralPose, Is.EqualTo(id is "M17" or "M45" ? firstOrder : finite), "M17 is singular all along its motion, M45 has none to leave its pose by");
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
                new AnalysisIsland
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

    // Gear 20:50, rack of radius 0.25, screw of lead 0.05, planet on a carrier at 24 / 84 of the sun.
    [TestCase("M25", "g1", "g2", Coordinate.Angle, -0.4)]
    [TestCase("M26", "pinion", "rack", Coordinate.X, 0.25 * Math.PI / 180)]
    [TestCase("M24", "screw", "nut", Coordinate.X, -0.05 / 360)]
    [TestCase("M27", "sun", "carrier", Coordinate.Angle, 24.0 / 60)]
    public void Coupling_ExportedAndDrivenTenTurnsAndBack_KeepsItsRatio(string id, string drive, string follower, Coordinate coordinate, double ratio)
    {
        var driven = new ExportedMechanism(id);
        foreach (double angle in new[] { 100.0, 3600, -3600, 0 })
        {
            driven.Drive(drive, Coordinate.Angle, angle);
            double unit = coordinate == Coordinate.Angle ? Math.PI / 180 : 1;
            Assert.That((driven.Value(follower, coordinate) - ratio * angle) * unit, Is.EqualTo(0).Within(1e-9), $"at {angle}");
        }
    }

    // Jaws that a palm carries, levers on the ground, jaws on parallelograms: driven by one of them, the parts stay images
    // of each other in the plane of the constraint, which is the palm's in the first.
    [TestCase("M48", "left", Coordinate.X, 0.04, "palm")]
    [TestCase("M49", "left", Coordinate.Angle, 35.0, null)]
    [TestCase("M50", "left0", Coordinate.Angle, -30.0, null)]
    public void Symmetry_ExportedAndDriven_KeepsThePartsEachOthersImages(string id, string part, Coordinate coordinate, double to, string? plane)
    {
        var driven = new ExportedMechanism(id);
        if (plane is not null)
        {
            driven.Drive(plane, Coordinate.Angle, 50);
        }

        Vector3d start = driven.Position("right"), at = driven.Axis("right", Vector3d.UnitX);
        foreach (double share in new[] { 0.0, 0.5, 1, -1, 0 })
        {
            driven.Drive((part, coordinate, share * to));
            Vector3d normal = plane is null ? Vector3d.UnitX : driven.Axis(plane, Vector3d.UnitY);
            Vector3d middle = plane is null ? Vector3d.Zero : driven.Position(plane) + 0.3 * driven.Axis(plane, Vector3d.UnitX);
            Vector3d left = driven.Position("left") - middle, right = driven.Position("right") - middle;
            Assert.That((right - (left - 2 * Vector3d.Dot(normal, left) * normal)).Length, Is.LessThan(1e-9), $"at {share}");
            bool moved = (driven.Position("right") - start).Length + (driven.Axis("right", Vector3d.UnitX) - at).Length > 1e-3;
            Assert.That(moved, Is.EqualTo(share != 0), $"at {share}");
        }
    }

    // Whole turns of all that can turn, through M05's and M39's flat poses and their start in one.
    [TestCase("M01", "crank")]
    [TestCase("M02", "crank")]
    [TestCase("M04", "crank")]
    [TestCase("M05", "crank")]
    [TestCase("M06", "b1")]
    [TestCase("M07", "crank")]
    [TestCase("M08", "crank")]
    [TestCase("M09", "shaft")]
    [TestCase("M10", "crank")]
    [TestCase("M12", "link1")]
    [TestCase("M21", "in")]
    [TestCase("M22", "in")]
    [TestCase("M23", "in")]
    [TestCase("M38", "v0")]
    [TestCase("M39", "v0")]
    public void Drive_FullTurnAndBack_ReturnsToTheStart(string id, string part)
    {
        var driven = new ExportedMechanism(id);
        MechanismState start = driven.State.Clone();
        foreach (double angle in new[] { 90.0, 180, 270, 360, 180, 0, 360, 0 })
        {
            driven.Drive(part, Coordinate.Angle, angle);
            if (angle is not (0 or 360))
            {
                continue;
            }

            for (int i = 0; i < start.Poses.Length; i++)
            {
                Vector3d turn = 2 * (driven.State.Poses[i].Rotation * start.Poses[i].Rotation.Conjugate()).Vector;
                Assert.That((driven.State.Poses[i].Position - start.Poses[i].Position).Length, Is.LessThan(1e-9), $"body {i} at {angle}");
                Assert.That(turn.Length, Is.LessThan(1e-9), $"body {i} at {angle}");
            }
        }
    }

    // Two cranks place the tip where the circles about their ends meet, on the side where it was.
    [TestCase(10, -20)]
    [TestCase(-25, 15)]
    [TestCase(40, 35)]
    public void FiveBar_ExportedWithTwoDrivers_MeetsTheCircles(double left, double right)
    {
        var bar = new ExportedMechanism("M33");
        Vector3d first = new(-0.2, 0.5, 0), tip = new(0.3, 1, 0), second = new(0.9, 0.6, 0), foot = new(0.8, 0, 0);
        double rodA = (tip - first).Length, rodB = (tip - second).Length;
        bar.Drive(("b1", Coordinate.Angle, left), ("b4", Coordinate.Angle, right));
        Vector3d a = Turn(first, Vector3d.Zero, left), b = Turn(second, foot, right);
        Vector3d along = b - a;
        double distance = along.Length;
        double x = (distance * distance + rodA * rodA - rodB * rodB) / (2 * distance);
        Vector3d unit = along * (1 / distance);
        Vector3d expected = a + unit * x + new Vector3d(-unit.Y, unit.X, 0) * Math.Sqrt(rodA * rodA - x * x);
        Assert.That((bar.Position("b3") - expected).Length, Is.LessThan(1e-9));

        static Vector3d Turn(Vector3d point, Vector3d about, double degrees) =>
            about + Quaterniond.AxisAngle(Vector3d.UnitZ, degrees * Math.PI / 180) * (point - about);
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
