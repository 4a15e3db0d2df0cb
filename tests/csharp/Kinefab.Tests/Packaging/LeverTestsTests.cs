using System;
using System.Diagnostics;
using System.IO;
using System.IO.Compression;
using System.Linq;
using System.Runtime.CompilerServices;
using NUnit.Framework;

namespace Kinefab.Tests.Packaging;

/// <summary>
/// A user's own test project, csharp/examples/LeverTests, as a user has it: in a folder of its own, with the packages
/// from a feed. What it needs besides ours comes from where this project's own packages came from.
/// </summary>
[Category("Packaging")]
public sealed class LeverTestsTests
{
    private string _folder = "";

    [SetUp]
    public void MakeFolder() => _folder = Directory.CreateTempSubdirectory("kinefab-packages-").FullName;

    [TearDown]
    public void RemoveFolder() => Directory.Delete(_folder, recursive: true);

    [Test]
    [CancelAfter(600_000)]
    public void LeverTests_FromThePackages_PassInDotnetTest()
    {
        string feed = Path.Combine(_folder, "feed");
        foreach (string package in new[] { "Kinefab", "Kinefab.NUnit" })
            Dotnet(Source($"src/{package}"), "pack", "--no-build", "-c", Configuration, "-o", feed);
        string project = Path.Combine(_folder, "LeverTests");
        Directory.CreateDirectory(project);
        foreach (string file in Directory.GetFiles(Source("examples/LeverTests")))
            File.Copy(file, Path.Combine(project, Path.GetFileName(file)));

        // Packages that are there already are not fetched again; ours are none of them.
        string home = Environment.GetEnvironmentVariable("NUGET_PACKAGES")
            ?? Path.Combine(Environment.GetFolderPath(Environment.SpecialFolder.UserProfile), ".nuget", "packages");
        string output = Dotnet(
            project, "test", "--nologo", $"-p:RestoreAdditionalProjectSources={feed}", $"-p:RestorePackagesPath={Path.Combine(_folder, "packages")}",
            $"-p:RestoreFallbackFolders={home}", "--logger", "console;verbosity=normal");
        Assert.That(output, Does.Match(@"Passed:\s+10\b|Total tests: 10\s+Passed: 10"), output);
    }

    [TestCase("Kinefab", "lib/net10.0/Kinefab.dll", "lib/netstandard2.1/Kinefab.dll", "README.md", "THIRD-PARTY-NOTICES.md")]
    [TestCase("Kinefab.NUnit", "lib/net8.0/Kinefab.NUnit.dll", "lib/net8.0/Kinefab.NUnit.xml", "README.md", "THIRD-PARTY-NOTICES.md")]
    public void Package_OfALibrary_HoldsWhatItPromises(string package, params string[] files)
    {
        Dotnet(Source($"src/{package}"), "pack", "--no-build", "-c", Configuration, "-o", _folder);
        using ZipArchive archive = ZipFile.OpenRead(Directory.GetFiles(_folder, $"{package}.*.nupkg").Single(file => !file.EndsWith(".snupkg", StringComparison.Ordinal)));
        Assert.That(files, Is.SubsetOf(archive.Entries.Select(entry => entry.FullName)));
        Assert.That(Directory.GetFiles(_folder, "*.snupkg"), Has.Length.EqualTo(1));
    }

    // Tests run from bin/CONFIGURATION/FRAMEWORK.
    private static string Configuration => Path.GetFileName(Path.GetDirectoryName(TestContext.CurrentContext.TestDirectory.TrimEnd(Path.DirectorySeparatorChar)))!;

    private static string Source(string folder, [CallerFilePath] string here = "") =>
        Path.GetFullPath(Path.Combine(Path.GetDirectoryName(here)!, "..", "..", "..", "..", "csharp", folder));

    private static string Dotnet(string folder, params string[] arguments)
    {
        var start = new ProcessStartInfo("dotnet", arguments) { WorkingDirectory = folder, RedirectStandardOutput = true, RedirectStandardError = true };
        foreach (string name in new[] { "MSBuildSDKsPath", "MSBUILD_EXE_PATH", "MSBuildExtensionsPath", "VSTEST_CONNECTION_TIMEOUT" })
            start.Environment.Remove(name);
        using Process process = Process.Start(start)!;
        System.Threading.Tasks.Task<string> errors = process.StandardError.ReadToEndAsync();
        string output = process.StandardOutput.ReadToEnd();
        process.WaitForExit();
        string all = output + errors.Result;
        Assert.That(process.ExitCode, Is.Zero, all);
        return all;
    }
}
