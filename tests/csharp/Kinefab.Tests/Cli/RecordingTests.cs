using System;
using System.IO;
using System.Text.Json.Nodes;
using NUnit.Framework;

namespace Kinefab.Tests.Cli;

/// <summary>simulate --record and --replay.</summary>
[NonParallelizable]
public sealed class RecordingTests
{
    private static readonly string Scene = Path.Combine(Dynamics.Scenario.Folder, "..", "..", "fixtures", "lever", "lever.kinefab");

    private string _folder = "";

    private string File(string name) => Path.Combine(_folder, name);

    [SetUp]
    public void MakeFolder() => _folder = Directory.CreateTempSubdirectory("kinefab").FullName;

    [TearDown]
    public void RemoveFolder() => Directory.Delete(_folder, recursive: true);

    [TestCase("unity")]
    [TestCase("exact")]
    public void Replay_OfARecordedRun_IsTheSame(string solver)
    {
        string record = File("run.kfrec");
        (int exit, string recorded, _) = CommandLineTests.Run("simulate", Scene, "--seconds", "0.5", "--step", "0.01", "--solver", solver, "--drive", "Crank:1=30", "--record", record, "--every", "7");

        (int replayed, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--replay", record);

        Assert.That((exit, replayed, findings), Is.EqualTo((0, 0, "")));
        Assert.That(data.TrimEnd(), Is.EqualTo($"{recorded.TrimEnd()}{Environment.NewLine}the same as {record}"));
        Assert.That(JsonSchema.Faults("recording.schema.json", System.IO.File.ReadAllText(record)), Is.Empty);
    }

    [TestCase(1, 0, "The start is")]
    [TestCase(1, 5, "Step 5 (0.05 s) is")]
    [TestCase(1, 50, "Step 50 (0.5 s) is")]
    [TestCase(7, 3, "One of the steps 15 to 21 (0.21 s) is")]
    [TestCase(7, 8, "Step 50 (0.5 s) is")]
    public void Replay_OfOtherHashes_NamesTheFirstStepThatDiffers(int every, int changed, string where)
    {
        string record = Record(every);
        Change(record, json =>
        {
            for (int i = changed; i < json["hashes"]!.AsArray().Count; i++)
                json["hashes"]![i] = "0123456789abcdef";
        });

        (int exit, _, string findings) = CommandLineTests.Run("simulate", Scene, "--replay", record);

        Assert.That(exit, Is.EqualTo(1));
        Assert.That(findings, Does.Contain($"error RECORDING_DIFFERS: {where} the first that differs from the recording {record}."));
    }

    // The second that is written took the first one's place; over the recording of a replay, the recording's.
    [TestCase("--record", "-o", "--output")]
    [TestCase("--record", "--junit", "--junit")]
    [TestCase("--output", "--junit", "--junit")]
    public void Simulate_TwoTargetsInOneFile_AreRefused(string first, string second, string named)
    {
        string file = File("run.json"), again = Path.Combine(_folder, ".", "run.json");
        (int exit, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--seconds", "0.1", first, file, second, again);
        Assert.That((exit, data, findings.TrimEnd()), Is.EqualTo((2, "", $"{named} {again}: it is {first}'s file too, and one of the two would be lost.")));
        Assert.That(System.IO.File.Exists(file), Is.False);
    }

    [Test]
    public void Replay_IntoItsOwnRecording_IsRefused()
    {
        string record = Record(1), kept = System.IO.File.ReadAllText(record);
        (int exit, _, string findings) = CommandLineTests.Run("simulate", Scene, "--replay", record, "--junit", record);
        Assert.That((exit, findings.TrimEnd()), Is.EqualTo((2, $"--junit {record}: it is --replay's file too, and one of the two would be lost.")));
        Assert.That(System.IO.File.ReadAllText(record), Is.EqualTo(kept));
    }

    [Test]
    public void Replay_WithAnotherScene_IsRefused()
    {
        string record = Record(1);
        string other = File("lever.kinefab");
        System.IO.File.WriteAllText(other, System.IO.File.ReadAllText(Scene) + "\n");
        foreach (string buffer in Directory.GetFiles(Path.GetDirectoryName(Scene)!, "*.bin"))
            System.IO.File.Copy(buffer, File(Path.GetFileName(buffer)));

        (int exit, string data, string findings) = CommandLineTests.Run("simulate", other, "--replay", record);

        Assert.That((exit, data), Is.EqualTo((1, "")));
        Assert.That(findings, Does.Contain("error RECORDING_OTHER_SCENE: "));
    }

    [Test]
    public void Replay_OfARecordingThatIsCutOffAnywhere_IsAFinding()
    {
        string record = Record(1);
        string whole = System.IO.File.ReadAllText(record);
        for (int length = 0; length < whole.Length - 1; length += 37)
        {
            System.IO.File.WriteAllText(record, whole[..length]);

            (int exit, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--replay", record);

            Assert.That((exit, data), Is.EqualTo((1, "")), $"{length} characters");
            Assert.That(findings, Does.Contain("error RECORDING_UNREADABLE: "));
        }
    }

    [TestCase("version", "\"2.0\"", "RECORDING_VERSION_UNKNOWN /version: The recording FILE is of version 2.0, this tool knows 1.0.")]
    [TestCase("version", "7", "version is no string")]
    [TestCase("format", "\"kinefab.scene\"", "its format is not kinefab.recording")]
    [TestCase("format", "3", "its format is not kinefab.recording")]
    [TestCase("scene", "\"abc\"", "scene is not 64 hexadecimal digits")]
    [TestCase("solver", "\"fast\"", "solver is fast; there are unity and exact")]
    [TestCase("step", "-1", "step is no number of seconds from 1E-09 on")]
    [TestCase("step", "1e-15", "step is no number of seconds from 1E-09 on")]
    [TestCase("step", "1e999", "step is no number of seconds from 1E-09 on")]
    [TestCase("step", "1e308", "steps of step seconds make no finite time")]
    [TestCase("steps", "49.5", "steps is no whole number from 1 to 1000000")]
    [TestCase("steps", "49", "it has 51 hashes; 49 steps with one for every 1 make 50")]
    [TestCase("every", "0", "every is no whole number from 1 to 1000000")]
    [TestCase("drives", "[3]", "drives[0] is no text")]
    [TestCase("drives", "null", "drives is no array")]
    [TestCase("drives", "[\"Door=30\"]", "RECORDING_UNREADABLE: The recording FILE cannot be read: its drive Door=30 is refused, no joint moves by this name; there are ")]
    [TestCase("drives", "[\"Crank:1=30\", \"Lever/Crank:1=40\"]", "its drive Lever/Crank:1=40 is refused, Crank:1=30 drives Lever/Crank:1 already, and a coordinate has one drive. ")]
    [TestCase("hashes", "[\"x\"]", "hashes[0] is not 16 hexadecimal digits")]
    [TestCase("hashes", "{}", "hashes is no array")]
    public void Replay_OfAWrongField_SaysWhich(string field, string value, string said)
    {
        string record = Record(1);
        Change(record, json => json[field] = JsonNode.Parse(value));

        (int exit, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--replay", record);

        Assert.That((exit, data), Is.EqualTo((1, "")));
        Assert.That(findings, Does.Contain(said.Replace("FILE", record, StringComparison.Ordinal)));
    }

    [TestCase("format", "its format is not kinefab.recording")]
    [TestCase("version", "version is no text of Unicode")]
    public void Replay_OfHalfASurrogatePair_IsAFinding(string field, string said)
    {
        string record = Record(1);
        string text = System.IO.File.ReadAllText(record);
        int value = text.IndexOf('"', text.IndexOf($"\"{field}\": ", StringComparison.Ordinal) + field.Length + 3) + 1;
        System.IO.File.WriteAllText(record, text.Insert(value, "\\ud800"));

        (int exit, _, string findings) = CommandLineTests.Run("simulate", Scene, "--replay", record);

        Assert.That(exit, Is.EqualTo(1));
        Assert.That(findings, Does.Contain($"error RECORDING_UNREADABLE: The recording {record} cannot be read: {said}"));
    }

    [TestCase("\"stepz\": 1,", "it has a field stepz, which no recording has")]
    [TestCase("\"steps\": 1,", "it has the field steps twice")]
    [TestCase("\"\\udc00\": 1,", "a field's name is no text of Unicode")]
    public void Replay_OfAFieldThatNoRecordingHasOrTwice_IsAFinding(string more, string said)
    {
        string record = Record(1);
        System.IO.File.WriteAllText(record, System.IO.File.ReadAllText(record).Insert(1, more));

        (int exit, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--replay", record);

        Assert.That((exit, data), Is.EqualTo((1, "")));
        Assert.That(findings, Does.Contain($"error RECORDING_UNREADABLE: The recording {record} cannot be read: {said}. "));
    }

    [TestCase("--record", "--seconds", "0.1")]
    [TestCase("--replay")]
    [TestCase("--junit", "--seconds", "0.1")]
    public void Run_AFileWithoutAName_IsWrongUsage(string option, params string[] more)
    {
        (int exit, _, string findings) = CommandLineTests.Run(["simulate", Scene, option, "", .. more]);

        Assert.That(exit, Is.EqualTo(2));
        Assert.That(findings, Does.StartWith($"{option} must name a file, not ''."));
    }

    [Test]
    public void Replay_OfNoFileOrAFolder_IsAFinding()
    {
        foreach ((string path, string said) in new[] { (File("missing.kfrec"), "there is no such file"), (_folder, "it is a folder") })
        {
            (int exit, _, string findings) = CommandLineTests.Run("simulate", Scene, "--replay", path);

            Assert.That(exit, Is.EqualTo(1));
            Assert.That(findings, Does.Contain($"error RECORDING_UNREADABLE: The recording {path} cannot be read: {said}. "));
        }
    }

    [Test]
    public void Every_WithoutARecording_Exits2()
    {
        (int exit, _, string findings) = CommandLineTests.Run("simulate", Scene, "--seconds", "1", "--every", "7");

        Assert.That(exit, Is.EqualTo(2));
        Assert.That(findings, Does.StartWith("--every says how often --record notes a hash"));
    }

    [TestCase("--seconds", "1")]
    [TestCase("--solver", "exact")]
    [TestCase("--drive", "Crank:1=3")]
    [TestCase("--every", "2")]
    public void Replay_BesideWhatTheRecordingSays_Exits2(string option, string value)
    {
        (int exit, _, string findings) = CommandLineTests.Run("simulate", Scene, "--replay", Record(1), option, value);

        Assert.That(exit, Is.EqualTo(2));
        Assert.That(findings, Does.StartWith($"{option} cannot be given beside --replay"));
    }

    [Test]
    public void Record_IntoAFolder_IsAFindingBeforeTheRun()
    {
        (int exit, string data, string findings) = CommandLineTests.Run("simulate", Scene, "--seconds", "1", "--record", _folder);

        Assert.That((exit, data), Is.EqualTo((1, "")));
        Assert.That(findings, Does.Contain("error TARGET_UNWRITABLE: "));
    }

    private string Record(int every)
    {
        string record = File("run.kfrec");
        CommandLineTests.Run("simulate", Scene, "--seconds", "0.5", "--step", "0.01", "--record", record, "--every", $"{every}");
        return record;
    }

    private static void Change(string path, Action<JsonNode> change)
    {
        JsonNode json = JsonNode.Parse(System.IO.File.ReadAllText(path))!;
        change(json);
        System.IO.File.WriteAllText(path, json.ToJsonString());
    }
}
