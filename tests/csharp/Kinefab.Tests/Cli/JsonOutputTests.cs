using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json;
using Kinefab.Cli;
using Kinefab.Tests.Advice;
using Kinefab.Tests.Conformance;
using Kinefab.Tests.Kinematics;
using NUnit.Framework;

namespace Kinefab.Tests.Cli;

/// <summary>What every command prints with --json follows its schema.</summary>
[NonParallelizable]
public sealed class JsonOutputTests
{
    // Of each command that takes --json, its schema and the field that it adds for a valid scene.
    private static readonly Dictionary<string, (string Schema, string? Field, string[] Options)> Outputs = new()
    {
        ["validate"] = ("report.schema.json", null, []),
        ["inspect"] = ("report.schema.json", "summary", []),
        ["mobility"] = ("report.schema.json", "mobility", []),
        ["advise"] = ("advice.schema.json", "advice", []),
        ["simulate"] = ("report.schema.json", "simulation", ["--seconds", "0.1"]),
        ["sweep"] = ("report.schema.json", "sweep", ["--joint", "Lever/Crank:1", "--steps", "5"]),
    };

    private static readonly string[] Commands = [.. Outputs.Keys];

    [Test]
    public void Commands_WithJson_AreAllHeldToASchema() =>
        Assert.That(
            Program.Commands().Subcommands.Where(command => command.Options.Any(option => option.Name == "--json")).Select(command => command.Name),
            Is.EquivalentTo(Commands));

    [TestCaseSource(nameof(Commands))]
    public void Json_ValidScene_FollowsItsSchema(string command)
    {
        (string schema, string? field, string[] options) = Outputs[command];

        string data = CommandLineTests.Run([command, AdviceScene.Lever, "--json", .. options]).Data;

        Assert.That(JsonSchema.Faults(schema, data), Is.Empty);
        if (field is not null)
            Assert.That(JsonDocument.Parse(data).RootElement.TryGetProperty(field, out _), field);
    }

    [TestCaseSource(nameof(Commands))]
    public void Json_InvalidScene_FollowsItsSchema(string command)
    {
        string invalid = Path.Combine(ConformanceCases.Folder, "invalid", "hinge", "limits_exchanged.kinefab");

        (int exit, string data, string findings) = CommandLineTests.Run([command, invalid, "--json", .. Outputs[command].Options]);

        Assert.That((exit, findings), Is.EqualTo((1, "")));
        Assert.That(JsonSchema.Faults(Outputs[command].Schema, data), Is.Empty);
    }

    [TestCase("\"idle\": [", "\"lazy\": [")]
    [TestCase("\"count\": 1", "\"count\": 0")]
    [TestCase("\"loops\": ", "\"loops\": -")]
    public void Schema_DamagedMobility_IsSeen(string good, string bad)
    {
        string data = CommandLineTests.Run("mobility", Path.Combine(ExportedMechanism.Fixtures, "mechanisms", "M19.kinefab"), "--json").Data;
        Assert.That(JsonSchema.Faults("report.schema.json", data), Is.Empty);
        Assert.That(data, Does.Contain(good));
        Assert.That(JsonSchema.Faults("report.schema.json", data.Replace(good, bad, System.StringComparison.Ordinal)), Is.Not.Empty);
    }
}
