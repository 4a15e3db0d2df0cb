using System;
using System.Diagnostics;
using System.IO;
using System.Linq;
using System.Text.Json;
using System.Xml.Linq;
using Kinefab.Tests.Conformance;
using NUnit.Framework;

namespace Kinefab.Tests.Cli;

/// <summary>Many files, patterns, standard input and JUnit reports; what cannot be printed is no success.</summary>
[NonParallelizable]
public sealed class ManyFilesTests
{
    private static readonly string Valid = Path.Combine(ConformanceCases.Folder, "valid", "hinge", "limits.kinefab");
    private static readonly string Invalid = Path.Combine(ConformanceCases.Folder, "invalid", "hinge", "limits_exchanged.kinefab");
    private static readonly string Fixtures = Path.Combine(ConformanceCases.Folder, "..", "..", "fixtures");
    private static readonly string FourBar = Path.Combine(Fixtures, "mechanisms", "M01.kinefab");
    private static readonly string Bar = Path.Combine(Fixtures, "mechanisms", "M05.kinefab");

    [Test]
    public void Validate_SeveralFiles_TellsEachAndExitsWithTheGreatest()
    {
        (int exit, string data, string findings) = CommandLineTests.Run("validate", Valid, Invalid);
        Assert.That(exit, Is.EqualTo(1));
        Assert.That(Lines(data), Is.EqualTo([$"{Valid}: valid, 0 errors, 0 warnings", $"{Invalid}: not valid, 1 error, 0 warnings"]));
        Assert.That(findings, Does.StartWith(Invalid + ":10:"));
        Assert.That(CommandLineTests.Run("validate", Valid, FourBar).Exit, Is.Zero);
    }

    [Test]
    public void Json_SeveralFiles_IsAnArrayOfTheObjectsOfEach()
    {
        foreach (string command in new[] { "validate", "inspect", "mobility" })
        {
            (int exit, string data, _) = CommandLineTests.Run(command, FourBar, Invalid, "--json");
            JsonElement[] all = [.. JsonDocument.Parse(data).RootElement.EnumerateArray()];
            Assert.That(exit, Is.EqualTo(1));
            Assert.That(all.Select(one => one.GetProperty("file").GetString()), Is.EqualTo([FourBar, Invalid]));
            Assert.That(all[0].GetRawText().Replace("\n  ", "\n", StringComparison.Ordinal), Is.EqualTo(CommandLineTests.Run(command, FourBar, "--json").Data.TrimEnd()));
        }
    }

    [Test]
    public void Patterns_OfFolders_AreExpandedByName()
    {
        string folder = Folder();
        foreach (string name in new[] { "b.kinefab", "a.kinefab", "sub/c.kinefab", "a.other" })
        {
            Directory.CreateDirectory(Path.GetDirectoryName(Path.Combine(folder, name))!);
            File.Copy(Valid, Path.Combine(folder, name));
        }

        Assert.That(Files("*.kinefab"), Is.EqualTo(["a.kinefab", "b.kinefab"]));
        Assert.That(Files("**/*.kinefab"), Is.EqualTo(["a.kinefab", "b.kinefab", "sub/c.kinefab"]));
        Assert.That(Files("s?b/*.kinefab"), Is.EqualTo(["sub/c.kinefab"]));
        Assert.That(Files("*.kinefab", "a.kinefab"), Is.EqualTo(["a.kinefab", "b.kinefab"]), "each once");
        (int exit, _, string findings) = CommandLineTests.Run("validate", Path.Combine(folder, "*.none"));
        Assert.That((exit, findings.Contains("SCENE_NOT_FOUND", StringComparison.Ordinal)), Is.EqualTo((1, true)));

        string[] Files(params string[] patterns) =>
            [.. Lines(CommandLineTests.Run(["validate", .. patterns.Select(p => folder + "/" + p)]).Data).Select(line => line[(folder.Length + 1)..line.LastIndexOf(": valid", StringComparison.Ordinal)])];
    }

    [Test]
    public void JUnit_OfAllCommands_HasOneCaseAFile()
    {
        string report = Path.Combine(Folder(), "kinefab.xml");
        (string[] Arguments, int Failures)[] calls =
        [
            (["validate", FourBar, Invalid], 1),
            (["mobility", FourBar, Bar], 0),
            (["simulate", FourBar, Invalid, "--seconds", "0.1"], 1),
            (["sweep", FourBar, Bar, "--joint", "crank", "--steps", "4"], 0),
            (["sweep", FourBar, Bar, "--joint", "nothing"], 2),
        ];
        foreach ((string[] arguments, int failures) in calls)
        {
            CommandLineTests.Run([.. arguments, "--junit", report]);
            XElement suite = XDocument.Load(report).Root!.Element("testsuite")!;
            Assert.That((int)suite.Attribute("tests")!, Is.EqualTo(2), arguments[0]);
            Assert.That((int)suite.Attribute("failures")!, Is.EqualTo(failures), arguments[0]);
            Assert.That(suite.Elements("testcase").Count(test => test.Element("failure") is not null), Is.EqualTo(failures), arguments[0]);
        }

        CommandLineTests.Run("validate", Invalid, "--junit", report);
        Assert.That((string?)XDocument.Load(report).Descendants("failure").Single().Attribute("message"), Does.Contain("HINGE_LIMITS_ORDER"));
    }

    [Test]
    public void JUnit_OfANameThatXmlCannotHold_IsXml()
    {
        string folder = Folder();
        string odd = Path.Combine(folder, "odd\u001b[31m<&>.kinefab");
        File.Copy(Invalid, odd);
        string report = Path.Combine(folder, "kinefab.xml");
        CommandLineTests.Run("validate", odd, "--junit", report);
        Assert.That((string?)XDocument.Load(report).Descendants("testcase").Single().Attribute("name"), Does.EndWith("odd\\u001B[31m<&>.kinefab"));
    }

    [TestCase("validate")]
    [TestCase("inspect")]
    [TestCase("mobility")]
    [TestCase("advise", "--seconds", "0.1", "--trials", "1")]
    [TestCase("simulate", "--seconds", "0.1")]
    [TestCase("sweep", "--joint", "rocker", "--steps", "3")]
    [TestCase("sweep", "--joint", "x\u001b[2J\r")]
    [TestCase("simulate", "--seconds", "0.1", "--drive", "x\u001b[2J=1")]
    [TestCase("validate", "--\u001b[2J")]
    public void Escapes_InNamesOfFilesAndArguments_NeverReachTheTerminal(params string[] command)
    {
        string odd = Path.Combine(Folder(), "a\u001b[31m\nb\u009b.kinefab");
        File.Copy(FourBar, odd);
        foreach (string buffer in Directory.GetFiles(Path.GetDirectoryName(FourBar)!, "M01.kinefab.*"))
            File.Copy(buffer, Path.Combine(Path.GetDirectoryName(odd)!, Path.GetFileName(buffer)));
        File.WriteAllText(odd, File.ReadAllText(odd).Replace("\"crank\"", "\"cr\\u001b[2Jank\\r\\n\"", StringComparison.Ordinal));
        foreach (string[] files in new string[][] { [odd], [odd, odd + "no"] })
        {
            (_, string data, string findings) = CommandLineTests.Run([command[0], .. files, .. command[1..]]);
            Assert.That((data + findings).ReplaceLineEndings("\n").Any(c => c != '\n' && char.IsControl(c)), Is.False, data + findings);
        }
    }

    // What is left out behind --junit or --record makes the first scene its value.
    [TestCase("validate", "--junit")]
    [TestCase("simulate", "--record", "--seconds", "0.1")]
    [TestCase("simulate", "--output", "--seconds", "0.1")]
    [TestCase("sweep", "--output", "--joint", "Crank")]
    public void Target_ThatIsASceneOfTheCall_IsRefused(string command, string option, params string[] more)
    {
        string scene = Path.Combine(Folder(), "scene.json"), other = Path.Combine(Path.GetDirectoryName(scene)!, ".", "scene.json");
        File.Copy(Valid, scene);
        (int exit, _, string findings) = CommandLineTests.Run([command, scene, option, other, .. more]);
        Assert.That((exit, findings.TrimEnd()), Is.EqualTo((2, $"{option} {other}: it is one of the scene files, and would be lost.")));
        Assert.That(File.ReadAllText(scene), Is.EqualTo(File.ReadAllText(Valid)));
    }

    // A file is written where a link leads; the scene was lost by its other name.
    [TestCase("validate", "--junit")]
    [TestCase("simulate", "--output", "--seconds", "0.1")]
    public void Target_ThatIsALinkToASceneOfTheCall_IsRefused(string command, string option, params string[] more)
    {
        string scene = Path.Combine(Folder(), "scene.kinefab"), link = Path.Combine(Path.GetDirectoryName(scene)!, "link.json");
        File.Copy(Valid, scene);
        File.CreateSymbolicLink(link, "scene.kinefab");
        (int exit, _, string findings) = CommandLineTests.Run([command, scene, option, link, .. more]);
        Assert.That((exit, findings.TrimEnd()), Is.EqualTo((2, $"{option} {link}: it is one of the scene files, and would be lost.")));
        Assert.That(File.ReadAllText(scene), Is.EqualTo(File.ReadAllText(Valid)));
    }

    // One file was listed forty times, until the system had enough of the links.
    [Test]
    public void Patterns_OverLinksThatLeadBack_ListEachFileOnce()
    {
        string folder = Folder();
        Directory.CreateDirectory(Path.Combine(folder, "v2"));
        File.Copy(Valid, Path.Combine(folder, "a.kinefab"));
        File.Copy(Valid, Path.Combine(folder, "v2", "b.kinefab"));
        Directory.CreateSymbolicLink(Path.Combine(folder, "v2", "back"), "..");
        Directory.CreateSymbolicLink(Path.Combine(folder, "current"), "v2");

        Assert.That(Files("**/*.kinefab"), Is.EqualTo(["a.kinefab", "v2/b.kinefab"]));
        Assert.That(Files("cur*/*.kinefab"), Is.EqualTo(["current/b.kinefab"]), "a link that is asked for");
        Assert.That(Files("cur*/**/*.kinefab"), Is.EqualTo(["current/b.kinefab", "current/back/a.kinefab"]));

        string[] Files(string pattern) =>
            [.. Lines(CommandLineTests.Run("validate", folder + "/" + pattern).Data).Select(line => line[(folder.Length + 1)..line.LastIndexOf(": valid", StringComparison.Ordinal)])];
    }

    [Test]
    public void Output_ForSeveralFiles_IsRefused()
    {
        (int exit, string data, string findings) = CommandLineTests.Run("simulate", FourBar, Bar, "--seconds", "1", "-o", "all.csv");
        Assert.That((exit, data), Is.EqualTo((2, "")));
        Assert.That(findings.TrimEnd(), Is.EqualTo("--output all.csv: it takes one scene file, not 2."));
    }

    [Test]
    public void Simulate_Json_SaysWhatTheTextSays([Values("unity", "exact")] string solver)
    {
        string data = CommandLineTests.Run("simulate", FourBar, "--seconds", "0.2", "--solver", solver, "--json").Data;
        JsonElement run = JsonDocument.Parse(data).RootElement.GetProperty("simulation");
        Assert.That((run.GetProperty("solver").GetString(), run.GetProperty("steps").GetInt32(), run.GetProperty("joints").GetArrayLength()), Is.EqualTo((solver, 10, 4)));
        Assert.That(run.GetProperty("joints")[0].GetProperty("coordinates")[0].GetProperty("unit").GetString(), Is.EqualTo("deg"));
    }

    [Test]
    public void Program_StandardInput_IsReadAndAFullDiskIsNoSuccess()
    {
        if (!OperatingSystem.IsLinux())
            Assert.Ignore("/dev/full is Linux's.");
        string tool = Path.Combine(AppContext.BaseDirectory, "dotnet-kinefab.dll");
        Assert.That(Shell($"dotnet '{tool}' validate - < '{Valid}'"), Is.EqualTo((0, "-: valid, 0 errors, 0 warnings\n")));
        Assert.That(Shell($"cat '{Invalid}' | dotnet '{tool}' validate - 2>/dev/null").Exit, Is.EqualTo(1));
        foreach (string arguments in new[] { $"validate '{Valid}' --json", $"validate '{Valid}'", $"inspect '{FourBar}'", $"sweep '{FourBar}' --joint crank --steps 3 --json" })
            Assert.That(Shell($"dotnet '{tool}' {arguments} > /dev/full 2>/dev/null").Exit, Is.EqualTo(3), arguments);
        Assert.That(Shell($"dotnet '{tool}' validate '{Valid}' 2>&1 >&-"), Is.EqualTo((3, "The output could not be written: Bad file descriptor\n")), "nobody takes it");
    }

    private static (int Exit, string Data) Shell(string line)
    {
        using Process process = Process.Start(new ProcessStartInfo("/bin/sh", ["-c", line]) { RedirectStandardOutput = true })!;
        string data = process.StandardOutput.ReadToEnd();
        process.WaitForExit();
        return (process.ExitCode, data);
    }

    private static string[] Lines(string text) => text.ReplaceLineEndings("\n").TrimEnd().Split('\n');

    private static string Folders => Path.Combine(TestContext.CurrentContext.WorkDirectory, "many");

    // Links that lead back, left there, keep whatever searches the repository next without following each place once, as docfx does.
    [OneTimeTearDown]
    public void RemoveFolders()
    {
        if (Directory.Exists(Folders))
            Directory.Delete(Folders, true);
    }

    private static string Folder()
    {
        string folder = Path.Combine(Folders, Guid.NewGuid().ToString("N"));
        Directory.CreateDirectory(folder);
        return folder;
    }
}
