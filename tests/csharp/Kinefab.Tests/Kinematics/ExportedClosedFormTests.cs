using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Tests.Conformance;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>
/// Every row of the table of closed forms, driven in the scene that the exporter made: lengths and angles within 1e-9
/// metres and radians of trigonometry, dead points within 1e-6 degrees.
/// </summary>
public class ExportedClosedFormTests
{
    private const double Tolerance = 1e-9;
    private const double Radians = Math.PI / 180;

    private static readonly Dictionary<string, Func<ExportedMechanism, double, double>> Measures = new()
    {
        ["M01 coupler angle deg"] = (m, crank) => Turned(m, "crank", crank).Angle("coupler"),
        ["M01 rocker angle deg"] = (m, crank) => Turned(m, "crank", crank).Angle("rocker"),
        ["M02 coupler angle deg"] = (m, crank) => Turned(m, "crank", crank).Angle("coupler"),
        ["M02 rocker angle deg"] = (m, crank) => Turned(m, "crank", crank).Angle("rocker"),
        ["M01 rocker limit deg (extended)"] = (m, _) => 180 - m.Angle("rocker") - m.Range("rocker").Low.Value,
        ["M01 rocker limit deg (folded)"] = (m, _) => 180 - m.Angle("rocker") - m.Range("rocker").High.Value,
        ["M03 crank limit +- deg"] = (m, _) => DeadCentre(m),
        ["M07 slider x"] = (m, crank) => Turned(m, "crank", crank).Position("slider").X,
        ["M07 stroke"] = (m, _) => Stroke(m),
        ["M08 slider x"] = (m, crank) => Turned(m, "crank", crank).Position("slider").X,
        ["M08 stroke"] = (m, _) => Stroke(m),
        ["M09 slider D x"] = (m, lever) => Turned(m, "shaft", lever).Position("sliderD").X,
        ["M09 bar C angle deg"] = (m, lever) => Turned(m, "shaft", lever).Angle("barC"),
        ["M10 yoke x"] = (m, crank) => Turned(m, "crank", crank).Position("yoke").X,
        ["M11 height h=2 l sin(phi)"] = (m, phi) => Driven(m, "lo_x", 50 - phi).Position("platform").Z,
        ["M12 theta2 deg, tan(t1/2)tan(t2/2)=K=2.23976411"] = (m, first) => SecondAngle(Driven(m, "link1", first - 80)),
        ["M12 DH loop closure error"] = (m, first) => Driven(m, "link1", first - 80).Open,
        ["M13 P3 x"] = (m, q) => Driven(m, "rod1", q).Position("rod3").X,
        ["M13 P3 y"] = (m, q) => Driven(m, "rod1", q).Position("rod3").Y,
        ["M13 P3 z"] = (m, q) => Driven(m, "rod1", q).Position("rod3").Z,
        ["M21 output angle deg, tan(out)=tan(in)*cos(beta)"] = OutputAngle,
        ["M21 velocity ratio w_out/w_in"] = (m, input) => OutputRatio(m, input),
        ["M23 disc centre x = e cos^2"] = (m, input) => Turned(m, "in", input).Position("disc").X,
        ["M23 disc centre y = e sin cos"] = (m, input) => Turned(m, "in", input).Position("disc").Y,
        ["M24 nut travel, lead .05, 2 turns"] = (m, screw) => Driven(m, "screw", screw).Position("nut").Z - 0.4,
        ["M25 driven gear deg (20:50)"] = (m, gear) => Driven(m, "g1", gear).Angle("g2"),
        ["M26 rack x = rp*theta"] = (m, pinion) => Driven(m, "pinion", pinion).Position("rack").X,
        ["M27 carrier deg = 24/84*sun"] = (m, sun) => SunTurned(m, sun).Angle("carrier"),
        ["M27 planet abs deg = (1-60/18)*carrier"] = (m, sun) => SunTurned(m, sun).Angle("planet"),
        ["M30 follower dy = -dx tan(20)"] = (m, dx) => Driven(m, "wedge", dx, Coordinate.X).Position("follower").Y - 0.3,
        ["M32 platform height L sin"] = (m, arm) => Turned(m, "arm1", arm).Position("platform").Y,
        ["M18 platform x at arms (30, 30, 30)"] = (m, _) => Arms(m, 30, 30, 30).X,
        ["M18 platform y at arms (30, 30, 30)"] = (m, _) => Arms(m, 30, 30, 30).Y,
        ["M18 platform z at arms (30, 30, 30)"] = (m, _) => Arms(m, 30, 30, 30).Z,
        ["M18 platform x at arms (10, 25, 40)"] = (m, _) => Arms(m, 10, 25, 40).X,
        ["M18 platform y at arms (10, 25, 40)"] = (m, _) => Arms(m, 10, 25, 40).Y,
        ["M18 platform z at arms (10, 25, 40)"] = (m, _) => Arms(m, 10, 25, 40).Z,
    };

    private static IEnumerable<TestCaseData> Rows() => Table()
        .Where(row => row.Id != "M14")
        .Select(row => new TestCaseData(row.Id, row.Quantity, row.Driver, row.Value).SetArgDisplayNames(row.Id, row.Quantity.Split(',')[0], row.Driver.ToString(CultureInfo.InvariantCulture)));

    [TestCaseSource(nameof(Rows))]
    public void Driven_ExportedScene_MeetsTheClosedForm(string id, string quantity, double driver, double expected)
    {
        double got = Measures[$"{id} {quantity}"](new ExportedMechanism(id), driver);
        if (quantity.Contains("limit", StringComparison.Ordinal))
        {
            Assert.That(got, Is.EqualTo(expected).Within(1e-6));
        }
        else if (quantity.Contains("deg", StringComparison.Ordinal))
        {
            Assert.That(FourBar.Wrap(got - expected) * Radians, Is.EqualTo(0).Within(Tolerance));
        }
        else
        {
            Assert.That(got, Is.EqualTo(expected).Within(Tolerance));
        }
    }

    [Test]
    public void Table_HoldsEveryFormThatIsMeasured()
    {
        string[] rows = Table().Where(r => r.Id != "M14").Select(r => $"{r.Id} {r.Quantity}").Distinct().ToArray();
        Assert.That(rows, Is.EquivalentTo(Measures.Keys));
        Assert.That(Table(), Has.Count.EqualTo(90));
    }

    // The six lengths belong to a platform at (0.08, -0.05, 1.25), turned by Rz(12) Ry(-7) Rx(5).
    [Test]
    public void StewartLegs_ExportedAndDrivenTogether_BringThePlatformToItsPose()
    {
        double[] lengths = Table().Where(row => row.Id == "M14").Select(row => row.Value).ToArray();
        double home = Math.Sqrt(1 + 0.36 - 1.2 * Math.Cos(40 * Radians) + 1.44);
        var stewart = new ExportedMechanism("M14");
        stewart.Drive(lengths.Select((length, k) => Leg(stewart, k + 1, length - home)).ToArray());
        Quaterniond turn = Quaterniond.AxisAngle(Vector3d.UnitZ, 12 * Radians)
            * Quaterniond.AxisAngle(Vector3d.UnitY, -7 * Radians) * Quaterniond.AxisAngle(Vector3d.UnitX, 5 * Radians);
        Assert.That((stewart.Position("platform") - new Vector3d(0.08, -0.05, 1.25)).Length, Is.LessThan(Tolerance));
        foreach (Vector3d axis in new[] { Vector3d.UnitX, Vector3d.UnitY, Vector3d.UnitZ })
        {
            Assert.That((stewart.Axis("platform", axis) - turn * axis).Length, Is.LessThan(Tolerance));
        }
    }

    // The slide of a leg stands on its upper or on its lower part, its axis up: the own body moves against the other.
    private static (string Part, Coordinate Coordinate, double Value) Leg(ExportedMechanism stewart, int leg, double longer)
    {
        int upper = stewart.Mechanism.GameObjectNamed($"up{leg}");
        return stewart.Mechanism.Coordinates.Any(c => c.GameObject == upper && c.Coordinate == Coordinate.X)
            ? ($"up{leg}", Coordinate.X, longer)
            : ($"lo{leg}", Coordinate.X, -longer);
    }

    private static ExportedMechanism Turned(ExportedMechanism mechanism, string part, double degrees)
    {
        mechanism.Turn(part, degrees);
        return mechanism;
    }

    private static ExportedMechanism Driven(ExportedMechanism mechanism, string part, double value, Coordinate coordinate = Coordinate.Angle)
    {
        mechanism.Drive(part, coordinate, value);
        return mechanism;
    }

    // Both ends are folds, at angles that are each other's negative.
    private static double DeadCentre(ExportedMechanism mechanism)
    {
        (RangeLimit low, RangeLimit high) = mechanism.Range("crank");
        Assert.That((low.End, high.End), Is.EqualTo((RangeEnd.Fold, RangeEnd.Fold)));
        Assert.That(mechanism.Angle("crank") + low.Value, Is.EqualTo(-mechanism.Angle("crank") - high.Value).Within(1e-6));
        return mechanism.Angle("crank") + high.Value;
    }

    private static double Stroke(ExportedMechanism mechanism)
    {
        (RangeLimit low, RangeLimit high) = mechanism.Range("slider", Coordinate.X);
        Assert.That((low.End, high.End), Is.EqualTo((RangeEnd.Fold, RangeEnd.Fold)));
        return high.Value - low.Value;
    }

    // link2's frame is link1's, twisted by 30 degrees about x and turned by the second angle.
    private static double SecondAngle(ExportedMechanism mechanism)
    {
        Vector3d x = mechanism.Axis("link1", Vector3d.UnitX);
        Vector3d y = mechanism.Axis("link1", new Vector3d(0, Math.Cos(30 * Radians), Math.Sin(30 * Radians)));
        Vector3d second = mechanism.Axis("link2", Vector3d.UnitX);
        return Math.Atan2(Vector3d.Dot(y, second), Vector3d.Dot(x, second)) / Radians;
    }

    private static double OutputAngle(ExportedMechanism mechanism, double input)
    {
        mechanism.Drive("in", Coordinate.Angle, input - 20);
        return mechanism.Value("out", Coordinate.Angle) + Math.Atan(Math.Tan(20 * Radians) * Math.Cos(30 * Radians)) / Radians;
    }

    // The derivative by differences of the fourth order.
    private static double OutputRatio(ExportedMechanism mechanism, double input)
    {
        const double h = 0.2;
        double near = OutputAngle(mechanism, input + h) - OutputAngle(mechanism, input - h);
        double far = OutputAngle(mechanism, input + 2 * h) - OutputAngle(mechanism, input - 2 * h);
        return (8 * near - far) / (12 * h);
    }

    // The sun's hinge stands on the carrier, which follows by 24 / 84.
    private static ExportedMechanism SunTurned(ExportedMechanism mechanism, double degrees)
    {
        mechanism.Drive("sun", Coordinate.Angle, degrees * 60 / 84);
        Assert.That(FourBar.Wrap(mechanism.Angle("sun") - degrees), Is.EqualTo(0).Within(Tolerance));
        return mechanism;
    }

    private static Vector3d Arms(ExportedMechanism mechanism, params double[] below)
    {
        mechanism.Drive(below.Select((angle, k) => ($"arm{k}", Coordinate.Angle, angle - 30)).ToArray());
        return mechanism.Position("platform");
    }

    private static List<(string Id, string Quantity, double Driver, double Value)> Table()
    {
        string path = Path.Combine(ConformanceCases.Folder, "..", "python", "data", "mechanisms", "closed_forms.csv");
        return File.ReadAllLines(path).Skip(1).Select(line =>
        {
            int end = line.LastIndexOf(',');
            int driver = line.LastIndexOf(',', end - 1);
            int id = line.IndexOf(',', StringComparison.Ordinal);
            return (line[..id], line[(id + 1)..driver].Trim('"'), Number(line[(driver + 1)..end]), Number(line[(end + 1)..]));
        }).ToList();

        static double Number(string text) => double.Parse(text, CultureInfo.InvariantCulture);
    }
}
