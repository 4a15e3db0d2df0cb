using System.IO;
using System.Linq;
using System.Text.Json;
using Kinefab.Tests.Advice;
using Kinefab.Tests.Conformance;
using NUnit.Framework;

namespace Kinefab.Tests.Cli;

[NonParallelizable]
public sealed class AdviseCommandTests
{
    private static readonly string Invalid = Path.Combine(ConformanceCases.Folder, "invalid", "hinge", "limits_exchanged.kinefab");

    [Test]
    public void Advise_Lever_SaysWhatToDoAndWhatCameOfIt()
    {
        (int exit, string data, string findings) = CommandLineTests.Run("advise", AdviceScene.Lever);
        using (Assert.EnterMultipleScope())
        {
            data = data.ReplaceLineEndings("\n");
            Assert.That((exit, findings), Is.EqualTo((0, "")));
            Assert.That(data, Does.Contain("100 steps of 0.02 s in Unity's solver and the exact one; 4 warnings"));
            Assert.That(data, Does.Contain("warning COLLIDERS_OVERLAP: The colliders of Lever/Base:1/body:Guide and Lever/SliderD:1 overlap by 0.016 m"));
            Assert.That(data, Does.Match(@"warning ADVICE_JOINT_DRIFTS: The HingeJoint Lever/BarC:1 - Lever/Crank:1 comes apart by [0-9.]+ mm and [0-9.]+ degrees within 2 s"));
            Assert.That(data, Does.Match(@"  do     [0-9.]+ mm and 0\.0[0-9.]+ degrees +X Motion, Angular Y Motion, Angular Z Motion Free -> Locked on ConfigurableJoint Lever/SliderD:1 - Lever/BarC:1\n"));
            Assert.That(data, Does.Match(@"  tried  [0-9.]+ mm and [0-9.]+ degrees +Project Settings > Physics > Default Solver Iterations 6 -> 12 \(Physics\.defaultSolverIterations\) \(1\.86 times the work\)\n"));
        }
    }

    [Test]
    public void Readme_AdviceOnTheLever_IsWhatTheToolSays()
    {
        string readme = File.ReadAllText(Path.Combine(ConformanceCases.Folder, "..", "..", "README.md")).ReplaceLineEndings("\n");
        string shown = readme.Split("```\n").Single(block => block.StartsWith("out/lever.kinefab: ", System.StringComparison.Ordinal));

        // As the exporter writes it by default, with --ground world.
        string lever = Path.GetFullPath(Path.Combine(ConformanceCases.Folder, "..", "..", "csharp", "examples", "LeverTests", "lever.kinefab"));
        string data = CommandLineTests.Run("advise", lever).Data.ReplaceLineEndings("\n");

        Assert.That(data.Replace(lever, "out/lever.kinefab", System.StringComparison.Ordinal), Does.StartWith(shown));
    }

    [Test]
    public void Advise_Words_AreExplainedBelowThemAndInTheHelp()
    {
        const string legend = "do: the best of the changes that were tried; tried: the others. The figure before a change is what is left once it is made, not what it gains.";

        Assert.That(CommandLineTests.Run("advise", AdviceScene.Lever, "--trials", "2").Data.TrimEnd(), Does.EndWith(legend));
        Assert.That(CommandLineTests.Run("advise", AdviceScene.Lever, "--trials", "2", "--json").Data, Does.Not.Contain("do: the best"));
        Assert.That(CommandLineTests.Run("advise", "--help").Data, Does.Contain(legend));
        string still = Path.Combine(ConformanceCases.Folder, "valid", "scene", "minimal.kinefab");
        Assert.That(CommandLineTests.Run("advise", still).Data, Does.Not.Contain(legend), "nothing was tried");
    }

    [Test]
    public void Advise_JsonTwice_IsTheSameAndFollowsItsSchema()
    {
        string first = CommandLineTests.Run("advise", AdviceScene.Lever, "--json").Data;
        string second = CommandLineTests.Run("advise", AdviceScene.Lever, "--json").Data;

        Assert.That(second, Is.EqualTo(first));
        Assert.That(JsonSchema.Faults("advice.schema.json", first), Is.Empty);
        using JsonDocument report = JsonDocument.Parse(first);
        JsonElement finding = report.RootElement.GetProperty("advice").GetProperty("findings")[0];
        Assert.That(report.RootElement.GetProperty("warnings").GetInt32(), Is.EqualTo(4));
        Assert.That(finding.GetProperty("tried").EnumerateArray().Count(t => t.GetProperty("best").GetBoolean()), Is.EqualTo(1));
    }

    [TestCase("\"steps\": 100", "\"steps\": 0")]
    [TestCase("\"severity\": \"warning\"", "\"severity\": \"grave\"")]
    [TestCase("\"best\": true", "\"best\": 1")]
    [TestCase("\"pointer\": ", "\"place\": ")]
    public void Schema_DamagedAdvice_IsSeen(string good, string bad)
    {
        string advice = CommandLineTests.Run("advise", AdviceScene.Lever, "--json", "--trials", "2").Data;
        Assert.That(advice, Does.Contain(good));
        Assert.That(JsonSchema.Faults("advice.schema.json", advice.Replace(good, bad, System.StringComparison.Ordinal)), Is.Not.Empty);
    }

    [Test]
    public void Advise_InvalidScene_GivesItsDiagnosticsAndNoAdvice()
    {
        (int exit, string data, string findings) = CommandLineTests.Run("advise", Invalid);
        Assert.That((exit, data), Is.EqualTo((1, "")));
        Assert.That(findings, Does.Contain("HINGE_LIMITS_ORDER"));

        (exit, data, findings) = CommandLineTests.Run("advise", Invalid, "--json");
        Assert.That((exit, findings), Is.EqualTo((1, "")));
        Assert.That(JsonSchema.Faults("advice.schema.json", data), Is.Empty);
        Assert.That(data, Does.Not.Contain("\"advice\""));
    }

    [Test]
    public void Advise_NoSuchFile_Exits1WithoutATrace()
    {
        (int exit, _, string findings) = CommandLineTests.Run("advise", "no_such.kinefab");
        Assert.That(exit, Is.EqualTo(1));
        Assert.That(findings, Does.Contain("SCENE_NOT_FOUND").And.Not.Contains("   at "));
    }

    [TestCase("--seconds", "0", "--seconds must be a positive number, not '0'.")]
    [TestCase("--seconds", "NaN", "--seconds must be a positive number, not 'NaN'.")]
    [TestCase("--seconds", "Infinity", "--seconds must be a positive number, not 'Infinity'.")]
    [TestCase("--seconds", "-1", "--seconds must be a positive number, not '-1'.")]
    [TestCase("--trials", "0", "--trials must be a whole number between 1 and 10000, not '0'.")]
    public void Advise_WrongValue_Exits2WithARule(string option, string value, string rule)
    {
        (int exit, string data, string findings) = CommandLineTests.Run("advise", AdviceScene.Lever, option, value);
        Assert.That((exit, data), Is.EqualTo((2, "")));
        Assert.That(findings, Does.StartWith(rule));
    }
}
