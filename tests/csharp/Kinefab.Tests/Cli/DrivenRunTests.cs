using System.IO;
using System.Linq;
using System.Text.Json;
using NUnit.Framework;

namespace Kinefab.Tests.Cli;

/// <summary>What simulate says of its drives: which are refused, which are doubtful, and what came of each.</summary>
[NonParallelizable]
public sealed class DrivenRunTests
{
    // A lid that opens from -35 to 55 degrees, and a carriage that slides.
    private static readonly string Scene = Path.Combine(Dynamics.Scenario.Folder, "..", "..", "fixtures", "hinge_slider_zup", "hinge_slider.kinefab");

    [TestCase("Lid:1=360001", "it must lie between -360000 and 360000 deg.")]
    [TestCase("Lid:1=-1e30", "it must lie between -360000 and 360000 deg.")]
    [TestCase("Lid:1=1e6/s", "it must lie between -360000 and 360000 deg/s.")]
    [TestCase("Carriage:1=1001", "it must lie between -1000 and 1000 m.")]
    [TestCase("Carriage:1=-1e6/s", "it must lie between -1000 and 1000 m/s.")]
    public void Simulate_DriveBeyondWhatASweepGoes_Exits2WithTheRange(string drive, string rule)
    {
        (int exit, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--seconds", "0.1", "--drive", drive);

        Assert.That((exit, data, findings.TrimEnd()), Is.EqualTo((2, "", $"--drive {drive}: {rule}")));
    }

    [TestCase("Lid:1=30", "Lid:1=60")]
    [TestCase("Lid:1=30", "Box/Lid:1.angle=5/s")]
    public void Simulate_CoordinateDrivenTwice_Exits2AndNamesBoth(string first, string second)
    {
        (int exit, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--seconds", "0.1", "--drive", first, "--drive", second);

        Assert.That((exit, data), Is.EqualTo((2, "")));
        Assert.That(findings, Does.StartWith($"--drive {second}: {first} drives ").And.Contain(" already"));
    }

    [TestCase("unity")]
    [TestCase("exact")]
    public void Simulate_GoalBeyondTheJointsOwnLimits_IsWarnedOfWithTheLimit(string solver)
    {
        (int exit, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--seconds", "1", "--solver", solver, "--drive", "Lid:1=-50");

        Assert.That(exit, Is.Zero);
        Assert.That(findings, Does.Match("warning DRIVE_BEYOND_LIMITS /gameObjects/[0-9]+/components/[0-9]+: .* is to go to -50 deg, and its own limits end at -35 deg\\. Ask for -35 to "));
        Assert.That(data, Does.Match("drive .*: asked -50 deg, reached -3[45][0-9.]* deg"));
    }

    // -35 is its limit.
    [TestCase("Lid:1=-35")]
    [TestCase("Lid:1=8999/s")]
    [TestCase("Carriage:1=900/s")]
    public void Simulate_DriveThatMayBe_HasNoFinding(string drive) =>
        Assert.That(CommandLineTests.Run("simulate", Scene, "--seconds", "0.02", "--drive", drive).Findings, Is.Empty);

    [Test]
    public void Simulate_AnglesOfASlerpDriveThatDiffer_AreToldOf()
    {
        string scene = Path.Combine(Directory.CreateTempSubdirectory("kinefab").FullName, "ball.kinefab");
        File.WriteAllText(scene, """
            {"format": "kinefab.scene", "version": "1.0", "gameObjects": [{"id": "ball", "name": "ball", "components": [{"type": "Rigidbody", "mass": 1, "inertiaTensor": [1, 1, 1]},
                {"type": "ConfigurableJoint", "xMotion": "Locked", "yMotion": "Locked", "zMotion": "Locked", "rotationDriveMode": "Slerp", "slerpDrive": {"positionDamper": 1}}]}]}
            """);

        (int exit, _, string findings) = CommandLineTests.Run("simulate", scene, "--seconds", "0.1", "--drive", "ball.angularY=20/s", "--drive", "ball.angularZ=15");

        Assert.That(exit, Is.Zero);
        Assert.That(findings, Does.Contain("warning DRIVE_SHARED /gameObjects/0/components/1: angularZ is driven to a goal"));
        Directory.Delete(Path.GetDirectoryName(scene)!, recursive: true);
    }

    [Test]
    public void Simulate_MoreThanHalfATurnInAStep_IsWarnedOfWithTheMost()
    {
        string findings = CommandLineTests.Run("simulate", Scene, "--seconds", "0.1", "--drive", "Lid:1=20000/s").Findings;

        Assert.That(findings, Does.Contain("warning DRIVE_SPEED_COARSE ").And.Contain("is to turn at 20000 deg/s, which is 400 degrees in a step of 0.02 s").And.Contain("less than 9000 deg/s"));
    }

    [Test]
    public void Simulate_Drives_AreEachToldWithWhatTheyReached()
    {
        string[] call = ["simulate", Scene, "--seconds", "2", "--solver", "exact", "--drive", "Lid:1=30", "--drive", "Carriage:1.x=0.02/s"];

        string[] lines = CommandLineTests.Run(call).Data.Split('\n').Where(line => line.StartsWith("drive ", System.StringComparison.Ordinal)).ToArray();
        string json = CommandLineTests.Run([.. call, "--json"]).Data;

        Assert.That(lines, Has.Length.EqualTo(2));
        Assert.That(lines[0], Does.Match("asked 30 deg, reached (30|29\\.99[0-9]*) deg"));
        Assert.That(lines[1], Does.Match("asked 0\\.02 m/s, reached 0\\.02 m/s"));
        Assert.That(JsonSchema.Faults("report.schema.json", json), Is.Empty);
        JsonElement[] drives = [.. JsonDocument.Parse(json).RootElement.GetProperty("simulation").GetProperty("drives").EnumerateArray()];
        Assert.That(drives.Select(drive => drive.GetProperty("drive").GetString()), Is.EqualTo(["Lid:1=30", "Carriage:1.x=0.02/s"]));
        Assert.That(drives.Select(drive => drive.GetProperty("asked").GetDouble()), Is.EqualTo([30, 0.02]));
        Assert.That(drives[0].GetProperty("reached").GetDouble(), Is.EqualTo(30).Within(0.01));
        Assert.That(drives[1].GetProperty("reached").GetDouble(), Is.EqualTo(0.02).Within(1e-9));
    }

    [Test]
    public void Help_Drive_SaysThatItMayBeRepeatedAndHowFarItGoes() =>
        Assert.That(CommandLineTests.Run("simulate", "--help").Data, Does.Contain("at most 360000 or 1000 (a second)").And.Contain("May be repeated"));
}
