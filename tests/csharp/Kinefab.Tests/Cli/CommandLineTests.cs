using System;
using System.IO;
using System.Linq;
using System.Text.Json;
using Kinefab.Cli;
using Kinefab.Tests.Conformance;
using NUnit.Framework;

namespace Kinefab.Tests.Cli;

[NonParallelizable]
public class CommandLineTests
{
    private static readonly string Valid = Path.Combine(ConformanceCases.Folder, "valid", "hinge", "limits.kinefab");
    private static readonly string Invalid = Path.Combine(ConformanceCases.Folder, "invalid", "hinge", "limits_exchanged.kinefab");
    private static readonly string Unknown = Path.Combine(ConformanceCases.Folder, "invalid", "scene", "unknown_field.kinefab");
    private static readonly string Described = Path.Combine(ConformanceCases.Folder, "valid", "scene", "every_section.kinefab");

    private static readonly string Lever = Path.Combine(ConformanceCases.Folder, "..", "..", "fixtures", "mechanisms", "M09.kinefab");

    [Test]
    public void Validate_ValidScene_SaysSoOnStdoutAndExits0()
    {
        (int exit, string data, string findings) = Run("validate", Valid);
        Assert.That((exit, data.TrimEnd(), findings), Is.EqualTo((0, Valid + ": valid, 0 errors, 0 warnings", "")));
    }

    [Test]
    public void Validate_InvalidScene_ListsFindingsOnStderrAndExits1()
    {
        (int exit, string data, string findings) = Run("validate", Invalid);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(exit, Is.EqualTo(1));
            Assert.That(data.TrimEnd(), Does.EndWith("not valid, 1 error, 0 warnings"));
            Assert.That(findings, Does.StartWith(Invalid + ":10:").And.Contains("error HINGE_LIMITS_ORDER /gameObjects/1/components/1/limits: "));
        }
    }

    [Test]
    public void Validate_Json_PrintsOneReportAndNothingElse()
    {
        (int exit, string data, string findings) = Run("validate", Invalid, "--json");
        using JsonDocument report = JsonDocument.Parse(data);
        JsonElement found = report.RootElement.GetProperty("diagnostics").EnumerateArray().Single();
        using (Assert.EnterMultipleScope())
        {
            Assert.That((exit, findings), Is.EqualTo((1, "")));
            Assert.That(report.RootElement.GetProperty("valid").GetBoolean(), Is.False);
            Assert.That(found.EnumerateObject().Select(field => field.Name), Is.EqualTo(["code", "severity", "pointer", "line", "column", "message", "remedy"]));
            Assert.That(found.GetProperty("line").GetInt32(), Is.EqualTo(10));
        }
    }

    [Test]
    public void Validate_Folder_SaysThatItIsOne()
    {
        string folder = Path.GetTempPath();
        (int exit, _, string findings) = Run("validate", folder);
        Assert.That((exit, findings.TrimEnd()), Is.EqualTo((1, $"{folder}: error SOURCE_IS_FOLDER: {folder} is a folder. Give the file in it.")));
    }

    [TestCase(0)]
    [TestCase(1, "--strict")]
    public void Validate_UnknownField_FailsOnlyWhenStrict(int expected, params string[] options) =>
        Assert.That(Run(["validate", Unknown, .. options]).Exit, Is.EqualTo(expected));

    [Test]
    public void Inspect_Scene_ShowsJointsMobilityAndLosses()
    {
        (int exit, string data, _) = Run("inspect", Described);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(exit, Is.Zero);
            Assert.That(data, Does.Contain("HingeJoint Box/Lid:1 - Box/Base:1: angle -10..80 deg"));
            Assert.That(data, Does.Contain("mobility   1 in 1 island"));
            Assert.That(data, Does.Contain("1 kept, 1 approximated, 1 dropped"));
            Assert.That(data, Does.Contain("dropped joint Cam:1 JOINT_UNKNOWN: No joint expresses it. (box.bundle.json#/joints/3)"));
        }
    }

    [TestCase("validate", "--strict")]
    [TestCase("inspect")]
    public void HumanOutput_ControlCharactersInTheFile_AreEscaped(params string[] arguments)
    {
        string path = Path.Combine(TestContext.CurrentContext.WorkDirectory, "control.kinefab");
        File.WriteAllText(
            path,
            """
            {"format": "kinefab.scene", "version": "1.0", "\u001b[2Jfield": 1,
             "gameObjects": [{"id": "a\u001b[31m\nb: valid, 0 errors\u202e", "name": "a", "components": [{"type": "Rigidbody"}, {"type": "FixedJoint"}]}]}
            """);
        (_, string data, string findings) = Run([.. arguments, path]);
        string lines = (data + findings).Replace("\r\n", "\n", StringComparison.Ordinal);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(lines, Does.Contain("\\u001B["));
            Assert.That(lines.Any(character => character != '\n' && (char.IsControl(character) || character == '\u202e')), Is.False);
            Assert.That(lines.Split('\n'), Has.None.StartsWith("b: valid"));
        }
    }

    [Test]
    public void Validate_OffsetNearTheLargestInteger_SaysWhereTheValuesWouldEnd()
    {
        string path = Path.Combine(TestContext.CurrentContext.WorkDirectory, "offset.kinefab");
        string source = File.ReadAllText(Path.Combine(ConformanceCases.Folder, "invalid", "buffer", "overrun.kinefab"));
        File.WriteAllText(path, System.Text.RegularExpressions.Regex.Replace(source, "\"offset\": *[1-9][0-9]*", "\"offset\": 9223372036854775804"));
        Assert.That(Run("validate", path).Findings, Does.Contain("BUFFER_OVERRUN").And.Not.Contain("byte -"));
    }

    [Test]
    public void Inspect_FeaturesLostForOneReason_HaveItOnce()
    {
        string path = Path.Combine(TestContext.CurrentContext.WorkDirectory, "alike.kinefab");
        File.WriteAllText(
            path,
            """
            {"format": "kinefab.scene", "version": "1.0", "gameObjects": [],
             "report": [{"feature": "collider A", "outcome": "approximated", "code": "COLLIDERS_NOT_CUT", "message": "Hollow."},
                        {"feature": "joint C", "outcome": "dropped", "code": "COLLIDERS_NOT_CUT", "message": "Hollow."},
                        {"feature": "collider B", "outcome": "approximated", "code": "COLLIDERS_NOT_CUT", "message": "Hollow.", "source": "b.json"}]}
            """);
        string data = Run("inspect", path).Data.ReplaceLineEndings("\n");
        Assert.That(data, Does.EndWith(
            "  approximated 2 features COLLIDERS_NOT_CUT: Hollow.\n    collider A\n    collider B (b.json)\n  dropped joint C COLLIDERS_NOT_CUT: Hollow.\n"));
    }

    [Test]
    public void Inspect_RatioOfAFineScrew_KeepsItsDigits()
    {
        string path = Path.Combine(TestContext.CurrentContext.WorkDirectory, "screw.kinefab");
        File.WriteAllText(
            path,
            """
            {"format": "kinefab.scene", "version": "1.0",
             "gameObjects": [{"id": "Nut", "name": "Nut", "components": [{"type": "Rigidbody"}, {"type": "ConfigurableJoint", "autoConfigureConnectedAnchor": false}]}],
             "couplings": [{"kind": "screw", "a": {"gameObject": 0, "component": 1, "coordinate": "angularX"},
                            "b": {"gameObject": 0, "component": 1, "coordinate": "x"}, "ratio": -2.7777777777778e-9}]}
            """);
        Assert.That(Run("inspect", path).Data, Does.Contain("Nut.x = -2.77778E-09 * Nut.angularX"));
    }

    [Test]
    public void Inspect_SeveralJointsOfOneObject_TellsThemApart()
    {
        string path = Path.Combine(TestContext.CurrentContext.WorkDirectory, "pair.kinefab");
        File.WriteAllText(
            path,
            """
            {"format": "kinefab.scene", "version": "1.1",
             "gameObjects": [{"id": "Base", "name": "Base", "components": [{"type": "Rigidbody"}]},
                             {"id": "Link", "name": "Link", "components": [{"type": "Rigidbody"}, {"type": "HingeJoint", "connectedBody": 0}, {"type": "HingeJoint", "connectedBody": 0, "axis": [0, 1, 0]}]},
                             {"id": "Lid", "name": "Lid", "components": [{"type": "Rigidbody"}, {"type": "HingeJoint", "connectedBody": 0}, {"type": "FixedJoint", "connectedBody": 0, "enabled": false}]}],
             "couplings": [{"kind": "gear", "a": {"gameObject": 1, "component": 2, "coordinate": "angle"}, "b": {"gameObject": 1, "component": 1, "coordinate": "angle"}, "ratio": 2}]}
            """);
        string data = Run("inspect", path).Data;
        using (Assert.EnterMultipleScope())
        {
            Assert.That(data, Does.Contain("HingeJoint Link[1] - Base: angle free").And.Contain("HingeJoint Link[2] - Base: angle free"));
            Assert.That(data, Does.Contain("Link[1].angle = 2 * Link[2].angle"));
            Assert.That(data, Does.Contain("HingeJoint Lid - Base").And.Contain("FixedJoint Lid[2] - Base: nothing free, switched off"));
        }

        Assert.That(Run("inspect", path, "--json").Data.Split("\"enabled\": false"), Has.Length.EqualTo(2));
    }

    [Test]
    public void Inspect_Json_HoldsTheSummary()
    {
        (_, string data, _) = Run("inspect", Described, "--json");
        using JsonDocument report = JsonDocument.Parse(data);
        JsonElement freedom = report.RootElement.GetProperty("summary").GetProperty("joints")[0].GetProperty("freedoms")[0];
        Assert.That(freedom.GetRawText().Replace("\n", "", StringComparison.Ordinal).Replace(" ", "", StringComparison.Ordinal), Is.EqualTo("""{"coordinate":"angle","unit":"deg","lower":-10,"upper":80}"""));
    }

    [TestCase("validate")]
    [TestCase("validate", "--nonsense", "a.kinefab")]
    [TestCase("explode")]
    [TestCase]
    public void AnyCommand_WrongUsage_Exits2(params string[] arguments)
    {
        (int exit, string data, string findings) = Run(arguments);
        using (Assert.EnterMultipleScope())
        {
            Assert.That((exit, data), Is.EqualTo((2, "")));
            Assert.That(findings, Does.Contain("--help"));
        }
    }

    [TestCase("'dotnet kinefab --help'")]
    [TestCase("'dotnet kinefab --help'", "explode")]
    [TestCase("'dotnet kinefab validate --help'", "validate")]
    [TestCase("'dotnet kinefab inspect --help'", "inspect", "--nonsense", "a.kinefab")]
    [TestCase("'dotnet kinefab mobility --help'", "mobility")]
    [TestCase("'dotnet kinefab advise --help'", "advise", "a.kinefab", "--trials", "0")]
    [TestCase("'dotnet kinefab simulate --help'", "simulate", "a.kinefab")]
    [TestCase("'dotnet kinefab sweep --help'", "sweep", "a.kinefab")]
    public void AnyCommand_WrongUsage_PointsToItsOwnHelp(string help, params string[] arguments) =>
        Assert.That(Run(arguments).Findings.TrimEnd().Split('\n')[^1], Does.StartWith("Run " + help));

    [TestCase("There is no command 'validat'. Near matches: validate.", "validat", "a.kinefab")]
    [TestCase("There is no command 'explode'.", "explode", "a.kinefab")]
    [TestCase("A command is missing.")]
    [TestCase("Unrecognized option '--stric'. Near matches: --strict. A file of this name is given as ./--stric.", "validate", "--stric", "a.kinefab")]
    public void AnyCommand_Mistyped_IsToldOnceWithWhatIsNear(string told, params string[] arguments) =>
        Assert.That(Run(arguments).Findings.ReplaceLineEndings("\n").TrimEnd().Split('\n')[..^1], Is.EqualTo([told]));

    [Test]
    public void Validate_ManyRemarksOfOneKind_TellsTheFirstAndHowManyMore()
    {
        string robot = Path.Combine(ConformanceCases.Folder, "invalid", "joint", "stated_axes_unfollowed.kinefab");
        (int exit, _, string findings) = Run("validate", robot);
        string[] lines = findings.ReplaceLineEndings("\n").TrimEnd().Split('\n');
        Assert.That((exit, lines.Count(line => line.Contains("info JOINT_STATED_UNFOLLOWED /", StringComparison.Ordinal))), Is.EqualTo((0, 4)));
        Assert.That(lines[^1], Is.EqualTo($"{robot}: info JOINT_STATED_UNFOLLOWED: 6 more remarks of this kind; --json lists all."));
        using JsonDocument all = JsonDocument.Parse(Run("validate", robot, "--json").Data);
        Assert.That(all.RootElement.GetProperty("diagnostics").GetArrayLength(), Is.EqualTo(10));
    }

    [TestCase(8, 8)]
    [TestCase(30, 9)]
    public void Validate_ManyWarningsOfOneKind_TellsTheFirstAndHowManyMore(int objects, int told)
    {
        string file = Path.Combine(TestContext.CurrentContext.WorkDirectory, $"alike{objects}.kinefab");
        string one = string.Join(",", Enumerable.Range(0, objects).Select(i => $$"""{"id":"o{{i}}","name":"o","colour":1}"""));
        File.WriteAllText(file, $$"""{"format":"kinefab.scene","version":"1.0","generator":{"name":"test","version":"1"},"gameObjects":[{{one}}]}""");
        (int exit, string data, string findings) = Run("validate", file);
        string[] lines = findings.ReplaceLineEndings("\n").TrimEnd().Split('\n');
        using JsonDocument all = JsonDocument.Parse(Run("validate", file, "--json").Data);
        using (Assert.EnterMultipleScope())
        {
            Assert.That((exit, lines.Length), Is.EqualTo((0, told)), findings);
            Assert.That(lines.Count(line => line.Contains("warning FIELD_UNKNOWN /", StringComparison.Ordinal)), Is.EqualTo(8));
            Assert.That(lines[^1].EndsWith("warning FIELD_UNKNOWN: 22 more warnings of this kind; --json lists all.", StringComparison.Ordinal), Is.EqualTo(told > 8));
            Assert.That(data, Does.Contain($"{objects} warnings"));
            Assert.That(all.RootElement.GetProperty("diagnostics").GetArrayLength(), Is.EqualTo(objects));
        }
    }

    [Test]
    public void Help_Simulate_SaysThatSecondsAreRequired() =>
        Assert.That(Run("simulate", "--help").Data, Does.Match("--seconds <seconds> .*Required, but for --replay"));

    [TestCase("validate")]
    [TestCase("inspect")]
    public void AnyCommand_NoSuchFile_Exits1WithoutATrace(string command)
    {
        (int exit, _, string findings) = Run(command, "no_such.kinefab");
        using (Assert.EnterMultipleScope())
        {
            Assert.That(exit, Is.EqualTo(1));
            Assert.That(findings, Does.Contain("SCENE_NOT_FOUND: There is no scene file no_such.kinefab").And.Not.Contains("validate").And.Not.Contains("   at "));
        }
    }

    [Test]
    public void Help_Root_NamesWhatTheCommandsDo() =>
        Assert.That(Run("--help").Data, Does.Contain("Validates, inspects, simulates and sweeps"));

    [TestCase("--steps", "1.5", "--steps must be a whole number between 1 and 1000000, not '1.5'.")]
    [TestCase("--from", "low", "--from must be a finite number, not 'low'.")]
    [TestCase("-o", "turn.txt", "--output must end in .json or .csv, not '.txt'.")]
    public void Sweep_WrongValue_Exits2WithARule(string option, string value, string rule)
    {
        (int exit, string data, string findings) = Run("sweep", Lever, "--joint", "x", option, value);
        Assert.That((exit, data), Is.EqualTo((2, "")));
        Assert.That(findings, Does.StartWith(rule));
    }

    internal static (int Exit, string Data, string Findings) Run(params string[] arguments)
    {
        TextWriter data = Console.Out, findings = Console.Error;
        using var dataText = new StringWriter();
        using var findingsText = new StringWriter();
        try
        {
            Console.SetOut(dataText);
            Console.SetError(findingsText);
            return (Program.Main(arguments), dataText.ToString(), findingsText.ToString());
        }
        finally
        {
            Console.SetOut(data);
            Console.SetError(findings);
        }
    }
}
