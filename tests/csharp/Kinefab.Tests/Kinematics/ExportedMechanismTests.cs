using System;
using System.Collections.Generic;
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
    private static readonly string Fixtures = Path.Combine(ConformanceCases.Folder, "..", "..", "fixtures");

    private static IEnumerable<TestCaseData> Scenes() => Directory.GetFiles(Fixtures, "*.kinefab", SearchOption.AllDirectories)
        .Order(StringComparer.Ordinal)
        .Select(path => new TestCaseData(path).SetArgDisplayNames(Path.GetFileNameWithoutExtension(path)));

    [TestCaseSource(nameof(Scenes))]
    public void Mobility_OfTheJoints_IsThatOfTheConstraints(string path)
    {
        ValidScene scene = Load(path);
        Report report = MobilityCheck.Compare(scene, MobilityAnalysis.Of(Mechanism.Create(scene)));
        Assert.That(report.Diagnostics.Where(d => d.Severity == Severity.Error).Select(d => d.ToString()), Is.Empty);
    }

    [Test]
    public void Mobility_AnotherNumberInTheFile_IsAnErrorWithBoth()
    {
        var scene = new MechanismScene { Analysis = new Analysis { Mobility = 2 } };
        scene.Hinge(scene.Body("lid", Vector3d.UnitX), null, Vector3d.Zero, Vector3d.UnitZ);
        var valid = new ValidScene(scene.Document());
        Report report = MobilityCheck.Compare(valid, MobilityAnalysis.Of(Mechanism.Create(valid)));
        Diagnostic found = report.Diagnostics.Single();
        Assert.That((found.Code, found.Pointer, found.Severity), Is.EqualTo((DiagnosticCodes.MobilityDiffers, "/analysis/mobility", Severity.Error)));
        Assert.That(found.Message, Does.Contain("is 2 in the file").And.Contain("1 counted from the joints"));
    }

    // The rocker's and coupler's angles by the cosine rule.
    [TestCase("M01", 0, 36.3360575146, 62.7203872640)]
    [TestCase("M01", 60, 18.3760176636, 64.9434811058)]
    [TestCase("M01", 150, 27.2546977717, 110.4593842727)]
    [TestCase("M01", 270, 62.4907216388, 123.8597318019)]
    [TestCase("M02", 60, -54.7975334437, -8.2300700015)]
    [TestCase("M02", 150, 14.1529244961, 97.3576109971)]
    [TestCase("M02", 300, 138.3760176636, -175.0565188942)]
    public void FourBar_Exported_MeetsClosedForm(string name, double crank, double coupler, double rocker)
    {
        var driven = new Exported(name);
        driven.Turn("crank", crank);
        Assert.That(FourBar.Wrap(driven.Angle("crank") - crank), Is.EqualTo(0).Within(1e-9), "the hinge reads the source's angle");
        Assert.That(FourBar.Wrap(driven.Angle("coupler") - coupler), Is.EqualTo(0).Within(1e-9));
        Assert.That(FourBar.Wrap(driven.Angle("rocker") - rocker), Is.EqualTo(0).Within(1e-9));
    }

    // x = r cos q + sqrt(l^2 - (r sin q - e)^2); the yoke: x = R cos q.
    [TestCase("M07", "crank", 0, "slider", 2)]
    [TestCase("M07", "crank", 60, "slider", 1.6861406616)]
    [TestCase("M07", "crank", 200, "slider", 1.0203736584)]
    [TestCase("M08", "crank", 0, "slider", 1.9866068747)]
    [TestCase("M08", "crank", 60, "slider", 1.7317911731)]
    [TestCase("M08", "crank", 200, "slider", 0.9835467977)]
    [TestCase("M09", "shaft", 0, "sliderD", 1.15)]
    [TestCase("M09", "shaft", 90, "sliderD", 0.8645808233)]
    [TestCase("M09", "shaft", 135, "sliderD", 0.7056914344)]
    [TestCase("M10", "crank", 100, "yoke", -0.0520944533)]
    [TestCase("M10", "crank", 250, "yoke", -0.1026060430)]
    [TestCase("M23", "in", 70, "disc", 0.0233955557)]
    [TestCase("M23", "in", 160, "disc", 0.1766044443)]
    [TestCase("M26", "pinion", 90, "rack", 0.3926990817)]
    public void Slider_Exported_MeetsClosedForm(string name, string drive, double degrees, string read, double x)
    {
        var driven = new Exported(name);
        driven.Turn(drive, degrees);
        Assert.That(driven.Position(read).X, Is.EqualTo(x).Within(1e-9));
    }

    [Test]
    public void PaperLever_Exported_TiltsTheBarByItsClosedForm()
    {
        var driven = new Exported("M09");
        driven.Turn("shaft", 90);
        Assert.That(driven.Angle("barC"), Is.EqualTo(-16.1276202132).Within(1e-9));
    }

    [Test]
    public void Gears_ExportedAndDrivenTenTurns_TurnByTheTeeth()
    {
        var driven = new Exported("M25");
        driven.Drive("g1", Coordinate.Angle, 3600);
        Assert.That(driven.Value("g2", Coordinate.Angle), Is.EqualTo(-1440).Within(1e-9));
    }

    // Sun 24, planet 18, ring 60 held: carrier = 24 / 84 sun, planet = (1 - 60 / 18) carrier.
    [Test]
    public void Planetary_Exported_TurnsByTheTeeth()
    {
        var driven = new Exported("M27");
        driven.Drive("sun", Coordinate.Angle, 150);
        Assert.That(FourBar.Wrap(driven.Angle("sun") - 210), Is.EqualTo(0).Within(1e-9));
        Assert.That(driven.Angle("carrier"), Is.EqualTo(60).Within(1e-9));
        Assert.That(driven.Angle("planet"), Is.EqualTo(-140).Within(1e-9));
    }

    [TestCase(35, 0.5735764364)]
    [TestCase(60, 0.8660254038)]
    public void Scissor_Exported_MeetsClosedForm(double arm, double height)
    {
        var driven = new Exported("M32");
        driven.Turn("arm1", arm);
        Assert.That(driven.Position("platform").Y, Is.EqualTo(height).Within(1e-9));
    }

    [Test]
    public void NonGrashofFourBar_Exported_EndsAtItsDeadCentres()
    {
        var driven = new Exported("M03");
        (RangeLimit low, RangeLimit high) = driven.Range("crank");
        Assert.That((low.End, high.End), Is.EqualTo((RangeEnd.Fold, RangeEnd.Fold)));
        Assert.That(driven.Angle("crank") + high.Value, Is.EqualTo(94.0960437582).Within(1e-6));
        Assert.That(driven.Angle("crank") + low.Value, Is.EqualTo(-94.0960437582).Within(1e-6));
    }

    // The minimal closure reads angles that mean nothing at a half turn; the mechanism itself moves on as before.
    [Test]
    public void Parallelogram_ExportedAndSweptThroughItsFlatPoses_ReportsNoJump()
    {
        var driven = new Exported("M04");
        SweepResult swept = driven.Sweep("crank", 360, 12);
        Assert.That(swept.Stop, Is.Null);
        Assert.That(swept.Jumps, Is.Empty);
    }

    private static ValidScene Load(string path)
    {
        SceneDocument document = SceneFile.Load(path).Document ?? throw new InvalidOperationException(path);
        return SceneValidator.Validate(document).Scene ?? throw new InvalidOperationException(path);
    }

    /// <summary>A scene from fixtures, driven; its sources are Y-up, so only x is mirrored.</summary>
    private sealed class Exported
    {
        private readonly ValidScene _scene;
        private readonly Mechanism _mechanism;
        private readonly MechanismState _state;
        private readonly PositionSolver _solver;

        public Exported(string name)
        {
            _scene = Load(Path.Combine(Fixtures, "mechanisms", name + ".kinefab"));
            _mechanism = Mechanism.Create(_scene);
            _state = _mechanism.NewState();
            _solver = new PositionSolver(_mechanism);
        }

        public void Turn(string part, double degrees) => Drive(part, Coordinate.Angle, degrees - Angle(part));

        public void Drive(string part, Coordinate coordinate, double value)
        {
            DriveResult result = _solver.Drive(_state, Find(part, coordinate), value);
            Assert.That(result.Converged, Is.True, $"{result.Status} at {result.Fraction}");
        }

        public double Value(string part, Coordinate coordinate) => _state.Coordinate(Find(part, coordinate));

        public (RangeLimit Low, RangeLimit High) Range(string part) => new Sweep(_solver).Range(_state, Find(part, Coordinate.Angle));

        public SweepResult Sweep(string part, double to, int steps) => new Sweep(_solver).Run(_state, Find(part, Coordinate.Angle), 0, to, steps);

        public Vector3d Position(string part) => Mirror(_state.Pose(Index(part)).Position);

        public double Angle(string part)
        {
            Vector3d x = Mirror(_state.Pose(Index(part)).Rotation * Mirror(Vector3d.UnitX));
            return Math.Atan2(x.Y, x.X) * (180 / Math.PI);
        }

        private static Vector3d Mirror(Vector3d v) => new(-v.X, v.Y, v.Z);

        private int Index(string part) => _scene.Document.GameObjects.ToList().FindIndex(o => o.Id == part);

        private int Find(string part, Coordinate coordinate) =>
            Enumerable.Range(0, _mechanism.Coordinates.Count).First(i => _mechanism.Coordinates[i].GameObject == Index(part) && _mechanism.Coordinates[i].Coordinate == coordinate);
    }
}
