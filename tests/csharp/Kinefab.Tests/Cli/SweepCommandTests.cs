using System;
using System.IO;
using System.Linq;
using System.Text.Json;
using Kinefab.Document;
using Kinefab.Tests.Kinematics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Cli;

[NonParallelizable]
public sealed class SweepCommandTests
{
    private string _folder = "";

    [SetUp]
    public void MakeFolder() => _folder = Directory.CreateTempSubdirectory("kinefab").FullName;

    [TearDown]
    public void RemoveFolder() => Directory.Delete(_folder, recursive: true);

    [Test]
    public void Sweep_Crank_SaysHowFarAndWritesTheClosedForm()
    {
        string file = Path.Combine(_folder, "motion.json");
        (int exit, string data, string findings) = CommandLineTests.Run("sweep", Scene("M07"), "--joint", "crank", "--from", "-40", "--to", "320", "--steps", "36", "-o", file);

        Assert.That((exit, findings), Is.EqualTo((0, "")));
        Assert.That(data, Does.Contain("swept      -40 to 320 deg in 36 steps").And.Contain("range      -360 (open) to 360 (open) deg").And.Not.Contain("branch"));
        using JsonDocument motion = JsonDocument.Parse(File.ReadAllText(file));
        JsonElement poses = motion.RootElement.GetProperty("bodies").EnumerateArray().Single(b => b.GetProperty("id").GetString() == "slider").GetProperty("poses");
        for (int i = 0; i <= 36; i++)
        {
            double q = i * Math.PI / 18;
            double x = 0.5 * Math.Cos(q) + Math.Sqrt(2.25 - 0.25 * Math.Sin(q) * Math.Sin(q));
            Assert.That(poses[i][0].GetDouble(), Is.EqualTo(-x).Within(1e-9));
        }
    }

    [Test]
    public void Sweep_Csv_NamesTheJointsOfOneObjectApart()
    {
        string file = Path.Combine(_folder, "motion.csv");
        CommandLineTests.Run("sweep", Scene("M05"), "--joint", "rocker[2]", "--from", "0", "--to", "10", "--steps", "2", "-o", file);
        string header = File.ReadAllLines(file)[0];
        Assert.That(header, Does.StartWith("driver rocker[2].angle,coupler.angle,crank.angle,rocker[1].angle,rocker[2].angle,coupler.px"));
        Assert.That(header.Split(',').Distinct().Count(), Is.EqualTo(header.Split(',').Length));
    }

    [Test]
    public void Sweep_OffAFlatPose_StatesTheBranchTakenAndTheOther()
    {
        (int exit, string data, _) = CommandLineTests.Run("sweep", Scene("M05"), "--joint", "crank", "--from", "0", "--to", "360");
        Assert.That(exit, Is.Zero);
        Assert.That(data, Does.Contain("branch     taken, the straightest of 2: coupler.angle -1, crank.angle +1, rocker[1].angle +1, rocker[2].angle +1"));
        Assert.That(data, Does.Contain("branch     not taken: coupler.angle -2.999, crank.angle +1"));
    }

    [Test]
    public void Sweep_NonGrashofCrank_EndsAtItsDeadCentres()
    {
        (_, string data, _) = CommandLineTests.Run("sweep", Scene("M03"), "--joint", "crank", "--from", "0", "--to", "180", "--steps", "4");
        Assert.That(data, Does.Contain("(dead centre) to ").And.Contain("stopped"));
    }

    [TestCase("nobody", "--joint nobody: no joint moves by this name; there are coupler.angle")]
    [TestCase("rocker", "--joint rocker: say which: rocker[1].angle, rocker[2].angle.")]
    public void Sweep_UnclearJoint_Exits2AndListsThem(string joint, string fault)
    {
        (int exit, string data, string findings) = CommandLineTests.Run("sweep", Scene("M05"), "--joint", joint);
        Assert.That((exit, data), Is.EqualTo((2, "")));
        Assert.That(findings, Does.StartWith(fault));
    }

    [TestCase("--to", "1e8", "between -360000 and 360000 deg for crank")]
    [TestCase("--from", "-360001", "between -360000 and 360000 deg for crank")]
    [TestCase("--steps", "1000001", "--steps must be a whole number between 1 and 1000000")]
    public void Sweep_FartherThanIsSwept_Exits2WithTheLimit(string option, string value, string limit)
    {
        (int exit, string data, string findings) = CommandLineTests.Run("sweep", Scene("M07"), "--joint", "crank", option, value);
        Assert.That((exit, data), Is.EqualTo((2, "")));
        Assert.That(findings, Does.Contain(limit));
    }

    [Test]
    public void Sweep_UnwritableTarget_Exits1BeforeTheSweepAndLeavesNothing()
    {
        string target = Path.Combine(_folder, "motion.csv");
        Directory.CreateDirectory(target);
        (int exit, string data, string findings) = CommandLineTests.Run("sweep", Scene("M07"), "--joint", "crank", "-o", target);
        Assert.That((exit, data), Is.EqualTo((1, "")));
        Assert.That(findings, Does.Contain($"error TARGET_UNWRITABLE: {target} cannot be written: it is a folder. Check the folder"));
        Assert.That(Directory.GetFileSystemEntries(_folder), Is.EqualTo(new[] { target }));
    }

    [Test]
    public void Sweep_MotionThatMemoryDoesNotHold_Exits2BeforeTheSweep()
    {
        (int exit, string data, string findings) = CommandLineTests.Run("sweep", Scene("M19"), "--joint", "arm0[1]", "--steps", "1000000");
        Assert.That((exit, data), Is.EqualTo((2, "")));
        Assert.That(findings, Does.StartWith("--steps 1000000: 1000000 steps of 10 bodies and ").And.Contain("at most 50000000 are kept. Give fewer steps."));
    }

    [Test]
    public void Sweep_CoordinateThatStandsStill_IsZeroWithoutASign()
    {
        string lever = Path.Combine(ExportedMechanism.Fixtures, "lever", "lever.kinefab");
        string data = CommandLineTests.Run("sweep", lever, "--joint", "Lever/Crank:1", "--from", "0", "--to", "90", "--steps", "30").Data;
        Assert.That(data, Does.Contain("Lever/SliderD:1[5].x 0 to 0 m").And.Not.Match(" -0[^.]"));
    }

    [Test]
    public void Sweep_OneStep_IsOneStep() =>
        Assert.That(CommandLineTests.Run("sweep", Scene("M07"), "--joint", "crank", "--from", "0", "--to", "5", "--steps", "1").Data, Does.Contain("in 1 step").And.Not.Contain("1 steps"));

    [Test]
    public void Sweep_IntoAnimation_AddsAClipThatValidates()
    {
        string file = Path.Combine(_folder, "M07.kinefab");
        File.Copy(Scene("M07"), file);
        for (int run = 0; run < 2; run++)
        {
            Assert.That(CommandLineTests.Run("sweep", file, "--joint", "crank", "--from", "0", "--to", "90", "--steps", "9", "--into-animation").Exit, Is.Zero);
        }

        AnimationClip clip = ValidScene.Load(file).Document.Animations.Single();
        Assert.That((clip.Name, clip.Times.Count, clip.Times[^1]), Is.EqualTo(("sweep crank", 10, 4.0)));
        Assert.That(clip.Tracks, Has.Count.EqualTo(3));
    }

    [Test]
    public void Mobility_Json_HoldsIdleFreedomsAndRedundantJoints()
    {
        (int exit, string data, _) = CommandLineTests.Run("mobility", Scene("M19"), "--json");
        using JsonDocument report = JsonDocument.Parse(data);
        JsonElement mobility = report.RootElement.GetProperty("mobility");
        Assert.That(exit, Is.Zero);
        Assert.That(mobility.GetProperty("mobility").GetInt32(), Is.EqualTo(9));
        Assert.That(mobility.GetProperty("idle").EnumerateArray().Sum(i => i.GetProperty("count").GetInt32()), Is.EqualTo(6));
        Assert.That(CommandLineTests.Run("mobility", Scene("M19")).Data, Does.Contain("idle       rod0a: 1 freedom moves nothing else"));
    }

    [Test]
    public void Mobility_FileWithAnotherCount_Exits1WithBothNumbers()
    {
        string file = Path.Combine(_folder, "M07.kinefab");
        File.WriteAllText(file, File.ReadAllText(Scene("M07")).Replace("\"analysis\": {\"mobility\": 1", "\"analysis\": {\"mobility\": 2", StringComparison.Ordinal));
        (int exit, _, string findings) = CommandLineTests.Run("mobility", file);
        Assert.That(exit, Is.EqualTo(1));
        Assert.That(findings, Does.Contain("MOBILITY_DIFFERS").And.Contain("is 2 in the file").And.Contain("1 counted from the joints"));
    }

    private static string Scene(string name) => Path.Combine(ExportedMechanism.Fixtures, "mechanisms", name + ".kinefab");
}
