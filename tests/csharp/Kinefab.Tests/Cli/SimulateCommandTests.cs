using System;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text.Json;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Tests.Conformance;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Cli;

[NonParallelizable]
public sealed class SimulateCommandTests
{
    private static readonly string Scene = Path.Combine(Dynamics.Scenario.Folder, "..", "..", "fixtures", "hinge_slider_zup", "hinge_slider.kinefab");

    private string _folder = "";

    [SetUp]
    public void MakeFolder() => _folder = Directory.CreateTempSubdirectory("kinefab").FullName;

    [TearDown]
    public void RemoveFolder() => Directory.Delete(_folder, recursive: true);

    [Test]
    public void Simulate_Scene_SumsUpEveryJointAndTheEnergy()
    {
        (int exit, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--seconds", "1", "--step", "0.005");

        using (Assert.EnterMultipleScope())
        {
            Assert.That((exit, findings), Is.EqualTo((0, "")));
            Assert.That(data, Does.Contain("200 steps of 0.005 s, unity solver"));
            Assert.That(data, Does.Match("energy .* J -> .* J"));
            Assert.That(data, Does.Match(@"Box/Lid:1 \(Lid:1\): drift .* m, .* deg, angle -35\.\.0 deg, limit reached at"));
            Assert.That(data, Does.Match(@"Box/Carriage:1 \(Carriage:1\): drift .* x .* m"));
        }
    }

    [Test]
    public void Simulate_StepsOfNoFiniteTime_AreRefused()
    {
        (int exit, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--seconds", "1.7e308", "--step", "1e308");
        Assert.That((exit, data), Is.EqualTo((2, "")));
        Assert.That(findings, Does.Contain("make no finite time"));
    }

    [Test]
    public void Simulate_DrivenJoints_ReachTheirValues()
    {
        string file = Path.Combine(_folder, "run.json");

        (int exit, _, string findings) = CommandLineTests.Run(
            "simulate", Scene, "--seconds", "2", "--step", "0.002", "-o", file, "--drive", "Box/Lid:1=30", "--drive", "Carriage:1.x=0.02/s");

        Assert.That((exit, findings), Is.EqualTo((0, "")));
        using JsonDocument run = JsonDocument.Parse(File.ReadAllText(file));
        JsonElement bodies = run.RootElement.GetProperty("bodies");
        // The carriage slides along Unity's +Z; 40 mm in 2 s. The lid goes 30 degrees up against its weight; after six
        // iterations Unity's solver leaves it a little short.
        Assert.That(Last(bodies, "Box/Carriage:1").Position.Z - First(bodies, "Box/Carriage:1").Position.Z, Is.EqualTo(0.04).Within(1e-4));
        Quaterniond turn = First(bodies, "Box/Lid:1").Rotation.Conjugate() * Last(bodies, "Box/Lid:1").Rotation;
        Assert.That(2 * Math.Acos(Math.Abs(turn.W)) * 180 / Math.PI, Is.EqualTo(30).Within(1));
        Assert.That(run.RootElement.GetProperty("times").GetArrayLength(), Is.EqualTo(1001));
    }

    [Test]
    public void Simulate_Csv_HoldsTheWorldsPoses()
    {
        string file = Path.Combine(_folder, "run.csv");

        CommandLineTests.Run("simulate", Scene, "--seconds", "0.1", "-o", file);

        string[] lines = File.ReadAllLines(file);
        World world = World.Create(ValidScene.Load(Scene));
        for (int i = 0; i < 5; i++)
        {
            world.Step(0.02);
        }

        Assert.That(lines, Has.Length.EqualTo(7), "a header, the start and five steps");
        Assert.That(lines[0], Does.StartWith("time,Box/Lid:1.angle,Box/Carriage:1.x,Box/Lid:1.px,Box/Lid:1.py"));
        double[] last = lines[^1].Split(',').Select(v => double.Parse(v, CultureInfo.InvariantCulture)).ToArray();
        Assert.That(last[0], Is.EqualTo(0.1).Within(1e-12));
        Assert.That(last[1], Is.EqualTo(((WorldHingeJoint)world.Joints[0]).Angle).Within(1e-9));
        Assert.That(last[5], Is.EqualTo(world.Bodies[0].Pose.Position.Z));
    }

    [TestCase(",")]
    [TestCase("\\n")]
    [TestCase("\\r")]
    [TestCase("\\\"")]
    public void Simulate_CsvOfAnOddId_QuotesIt(string odd)
    {
        string scene = Path.Combine(_folder, "odd.kinefab"), file = Path.Combine(_folder, "run.csv");
        File.WriteAllText(scene, File.ReadAllText(Path.Combine(ConformanceCases.Folder, "valid", "hinge", "limits.kinefab")).Replace("\"id\": \"", $"\"id\": \"a{odd}", StringComparison.Ordinal));

        CommandLineTests.Run("simulate", scene, "--seconds", "0.02", "-o", file);

        string id = JsonDocument.Parse($"\"a{odd}\"").RootElement.GetString()!.Replace("\"", "\"\"", StringComparison.Ordinal);
        Assert.That(File.ReadAllText(file), Does.StartWith("time,").And.Contain($",\"{id}"));
    }

    // Driven at 720 degrees a second, so that a wrapped angle would show.
    [Test]
    public void Simulate_Json_HoldsTheSweepsCoordinatesUnwrapped()
    {
        string crank = Path.Combine(Dynamics.Scenario.Folder, "..", "..", "fixtures", "mechanisms", "M07.kinefab");
        string run = Path.Combine(_folder, "run.json");
        string swept = Path.Combine(_folder, "swept.json");
        CommandLineTests.Run("simulate", crank, "--seconds", "2", "--step", "0.002", "--solver", "exact", "-o", run, "--drive", "crank=720/s");
        CommandLineTests.Run("sweep", crank, "--joint", "crank", "--from", "0", "--to", "360", "--steps", "8", "-o", swept);

        using JsonDocument time = JsonDocument.Parse(File.ReadAllText(run));
        using JsonDocument driver = JsonDocument.Parse(File.ReadAllText(swept));
        Assert.That(Names(time), Is.EqualTo(Names(driver)));
        double[] angles = Values(time, Array.IndexOf(Names(time), "crank 1 angle"));
        Assert.That(angles[^1], Is.GreaterThan(1000));
        Assert.That(Enumerable.Range(1, angles.Length - 1).Max(i => Math.Abs(angles[i] - angles[i - 1])), Is.LessThan(10));

        // x = 0.5 cos q + sqrt(1.5^2 - 0.25 sin^2 q), from q = 40 degrees.
        double[] slides = Values(time, Array.FindIndex(Names(time), n => n.StartsWith("slider", StringComparison.Ordinal)));
        double start = Slide(0);
        for (int i = 0; i < angles.Length; i += 50)
        {
            Assert.That(slides[i], Is.EqualTo(Slide(angles[i]) - start).Within(1e-6));
        }

        static double Slide(double angle)
        {
            double q = (angle + 40) * Math.PI / 180;
            return 0.5 * Math.Cos(q) + Math.Sqrt(2.25 - 0.25 * Math.Sin(q) * Math.Sin(q));
        }

        static string[] Names(JsonDocument of) => of.RootElement.GetProperty("coordinates").EnumerateArray()
            .Select(c => $"{c.GetProperty("id").GetString()} {c.GetProperty("component").GetInt32()} {c.GetProperty("coordinate").GetString()}").ToArray();

        static double[] Values(JsonDocument of, int index) =>
            of.RootElement.GetProperty("coordinates")[index].GetProperty("values").EnumerateArray().Select(v => v.GetDouble()).ToArray();
    }

    [Test]
    public void Simulate_JointsOfTheSource_AreCalledAsItsUserCallsThem()
    {
        string lever = Path.Combine(Dynamics.Scenario.Folder, "..", "..", "csharp", "examples", "LeverTests", "lever.kinefab");
        string data = CommandLineTests.Run("simulate", lever, "--seconds", "0.02").Data;
        Assert.That(data, Does.Contain("Lever/Crank:1 \"Shaft\": drift ").And.Contain("Lever/BarC:1[5] \"Slider pin\": drift "));
        Assert.That(CommandLineTests.Run("sweep", lever, "--joint", "Shaft", "--steps", "1").Data, Does.Match("Lever/SliderD:1.x \"Slide\" .* m").And.Match("worst gap  [0-9.e-]+ m"));
    }

    [Test]
    public void Simulate_ExactSolver_MovesTheExportedLeverWithoutDriftOrLossOfEnergy()
    {
        string lever = Path.Combine(Dynamics.Scenario.Folder, "..", "..", "fixtures", "lever", "lever.kinefab");

        (int exit, string data, string findings) = CommandLineTests.Run("simulate", lever, "--seconds", "0.5", "--solver", "exact");

        Assert.That((exit, findings), Is.EqualTo((0, "")));
        Assert.That(data, Does.Contain("25 steps of 0.02 s, exact solver").And.Contain("(0 J)"));
        Assert.That(data, Does.Match(@"Lever/Crank:1 \(Crank:1\): drift [0-9.]+e-1[0-9] m"));
        Assert.That(data, Does.Contain("angularZ 0..0 deg").And.Not.Contain("-0..").And.Not.Contain("..-0 "));
    }

    // Its rocker carries the hinge to the base and the one that closes the loop.
    [Test]
    public void Simulate_TwoJointsOnOneObject_AreDrivenAndToldApartByTheirComponents()
    {
        string flat = Path.Combine(Dynamics.Scenario.Folder, "..", "..", "fixtures", "mechanisms", "M05.kinefab");

        (int exit, string data, string findings) = CommandLineTests.Run("simulate", flat, "--seconds", "0.1", "--drive", "rocker[1]=5", "--drive", "rocker[2].angle=-1/s");
        (int refused, _, string unclear) = CommandLineTests.Run("simulate", flat, "--seconds", "0.1", "--drive", "rocker=5");

        Assert.That((exit, findings), Is.EqualTo((0, "")));
        Assert.That(data, Does.Contain("\nrocker[1] (rocker): ").And.Contain("\nrocker[2] (rocker): ").And.Contain("\ncrank (crank): "));
        Assert.That((refused, unclear.TrimEnd()), Is.EqualTo((2, "--drive rocker=5: say which: rocker[1].angle, rocker[2].angle.")));
    }

    [TestCase("--seconds", "1e9")]
    [TestCase("--seconds", "1", "--step", "1e-9")]
    [TestCase("--seconds", "1e300", "--step", "1e-300")]
    public void Simulate_MoreStepsThanAreRun_Exits2WithTheLimit(params string[] options)
    {
        (int exit, string data, string findings) = CommandLineTests.Run(["simulate", Scene, .. options]);

        Assert.That((exit, data), Is.EqualTo((2, "")));
        Assert.That(findings, Does.Contain("at most 1000000 are run"));
    }

    // Rounding alone moved the lever at metres a second in such steps; in shorter ones the run stopped, and a still shorter step was advised.
    [TestCase("unity")]
    [TestCase("exact")]
    public void Run_StepThatIsShorterThanNumbersTell_IsRefused(string solver)
    {
        (int exit, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--seconds", "3e-15", "--step", "1e-15", "--solver", solver);

        Assert.That((exit, data), Is.EqualTo((2, "")));
        Assert.That(findings, Does.StartWith("A step of 1E-15 s is shorter than 1E-09 s: ").And.Contain("Give a longer --step."));
        Assert.That(CommandLineTests.Run("simulate", Scene, "--seconds", "3e-9", "--step", "1e-9", "--solver", solver).Exit, Is.EqualTo(0));
    }

    [TestCase("--seconds 1 is less than one step of 20 s", "--seconds", "1", "--step", "20")]
    [TestCase("--seconds 1 is less than one step of 1.2 s", "--seconds", "1", "--step", "1.2")]
    [TestCase("--seconds 0.001 is less than one step of 0.02 s", "--seconds", "0.001")]
    public void Simulate_StepLongerThanTheRun_Exits2InsteadOfRunningOn(string fault, params string[] options)
    {
        (int exit, string data, string findings) = CommandLineTests.Run(["simulate", Scene, .. options]);

        Assert.That((exit, data, findings.TrimEnd()), Is.EqualTo((2, "", $"{fault}. Give more seconds or a shorter --step.")));
    }

    [Test]
    public void Simulate_StepAsLongAsTheRunInFloats_IsOneStep()
    {
        (int exit, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--seconds", "0.1", "--step", "0.10000000149011612");

        Assert.That((exit, findings), Is.EqualTo((0, "")), data);
    }

    // 10 bodies, 1 + 7 * 10 + 41 numbers a pose: without a trajectory the run is as long as any other.
    [Test]
    public void Simulate_TrajectoryThatMemoryDoesNotHold_Exits2BeforeTheRun()
    {
        string delta = Path.Combine(Dynamics.Scenario.Folder, "..", "..", "fixtures", "mechanisms", "M19.kinefab");

        (int exit, string data, string findings) = CommandLineTests.Run("simulate", delta, "--seconds", "20000", "-o", Path.Combine(_folder, "run.json"));

        Assert.That((exit, data), Is.EqualTo((2, "")));
        Assert.That(findings, Does.Contain("1000000 steps of 10 bodies and ").And.Contain("at most 50000000 are kept. Give fewer seconds or a longer --step."));
        Assert.That(Directory.GetFiles(_folder), Is.Empty);
    }

    [Test]
    public void Simulate_JointOfASceneWithoutJoints_SaysThatNothingMoves()
    {
        string still = Path.Combine(Conformance.ConformanceCases.Folder, "valid", "scene", "minimal.kinefab");

        (int exit, _, string findings) = CommandLineTests.Run("simulate", still, "--seconds", "1", "--drive", "a=1");
        (int swept, _, string sweepFindings) = CommandLineTests.Run("sweep", still, "--joint", "a");

        Assert.That((exit, findings.TrimEnd()), Is.EqualTo((2, "--drive a=1: no joint of the scene moves.")));
        Assert.That((swept, sweepFindings.TrimEnd()), Is.EqualTo((2, "--joint a: no joint of the scene moves.")));
    }

    [TestCase("--seconds", "0")]
    [TestCase("--seconds", "-1")]
    [TestCase("--seconds", "1", "--step", "0")]
    [TestCase("--seconds", "1", "--solver", "magic")]
    [TestCase("--seconds", "1", "--drive", "Box/Lid:1")]
    [TestCase("--seconds", "1", "--drive", "Box/Lid:1=much")]
    [TestCase("--seconds", "1", "--drive", "Nobody=1")]
    [TestCase("--seconds", "1", "--drive", "Box/Lid:1.x=1")]
    [TestCase]
    public void Simulate_WrongUsage_Exits2WithoutData(params string[] options)
    {
        (int exit, string data, string findings) = CommandLineTests.Run(["simulate", Scene, .. options]);

        Assert.That((exit, data), Is.EqualTo((2, "")));
        Assert.That(findings, Is.Not.Empty.And.Not.Contains("   at "));
    }

    [TestCase("--seconds", "abc", "--seconds must be a positive number, not 'abc'.")]
    [TestCase("--seconds", "NaN", "--seconds must be a positive number, not 'NaN'.")]
    [TestCase("--solver", "magic", "--solver must be unity or exact, not 'magic'.")]
    [TestCase("-o", "run", "--output must end in .json or .csv, not ''.")]
    [TestCase("-o", "run.jsn", "--output must end in .json or .csv, not '.jsn'.")]
    [TestCase("--drive", "Lid:1.foo=2", "--drive Lid:1.foo=2: foo is no coordinate; the joint has angle.")]
    [TestCase("--drive", "Carriage:1.angularY=2", "--drive Carriage:1.angularY=2: the joint does not move along angularY; the joint has x.")]
    public void Simulate_WrongValue_SaysTheRule(string option, string value, string rule)
    {
        string[] seconds = option == "--seconds" ? [] : ["--seconds", "1"];

        (int exit, string data, string findings) = CommandLineTests.Run(["simulate", Scene, option, value, .. seconds]);

        Assert.That((exit, data), Is.EqualTo((2, "")));
        Assert.That(findings, Does.StartWith(rule));
    }

    [Test]
    public void Help_Solver_IsNamedInTheWordsItTakes() =>
        Assert.That(CommandLineTests.Run("simulate", "--help").Data, Does.Contain("unity|exact").And.Not.Contains("Unity|").And.Not.Contains("default: Unity"));

    [TestCase("missing/run.json", "its folder does not exist")]
    [TestCase("folder.csv", "it is a folder")]
    public void Simulate_UnwritableTarget_Exits1BeforeTheRunAndLeavesNothing(string name, string reason)
    {
        Directory.CreateDirectory(Path.Combine(_folder, "folder.csv"));
        string target = Path.Combine(_folder, name);

        (int exit, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--seconds", "0.1", "-o", target);

        Assert.That((exit, data), Is.EqualTo((1, "")), "refused before the run, so there is no summary");
        Assert.That(findings.TrimEnd(), Is.EqualTo($"{Scene}: error TARGET_UNWRITABLE: {target} cannot be written: {reason}. Check the folder, the free space and the rights."));
        Assert.That(Directory.GetFileSystemEntries(_folder), Is.EqualTo(new[] { Path.Combine(_folder, "folder.csv") }));
    }

    private static Pose First(JsonElement bodies, string id) => PoseOf(Poses(bodies, id)[0]);

    private static Pose Last(JsonElement bodies, string id) => PoseOf(Poses(bodies, id)[^1]);

    private static JsonElement[] Poses(JsonElement bodies, string id) =>
        bodies.EnumerateArray().Single(b => b.GetProperty("id").GetString() == id).GetProperty("poses").EnumerateArray().ToArray();

    private static Pose PoseOf(JsonElement pose)
    {
        double[] v = pose.EnumerateArray().Select(e => e.GetDouble()).ToArray();
        return new Pose(new Vector3d(v[0], v[1], v[2]), new Quaterniond(v[3], v[4], v[5], v[6]));
    }
}
