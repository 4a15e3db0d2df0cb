using System;
using System.Diagnostics;
using System.IO;
using System.Linq;
using System.Runtime.CompilerServices;
using System.Threading.Tasks;
using NUnit.Framework;

namespace Kinefab.Tests.Packaging;

/// <summary>A folder with this project's packages as a feed, and a project's folder beside it; removed when done with.</summary>
internal sealed class PackageFeed : IDisposable
{
    private static readonly string[] NotToBeHad = ["NU1101", "NU1102", "NU1301", "Platform linker not found"];

    private readonly string _root = Directory.CreateTempSubdirectory("kinefab-packages-").FullName;

    /// <summary>Packs what was built for the tests.</summary>
    public PackageFeed(params string[] packages)
    {
        Project = Directory.CreateDirectory(Path.Combine(_root, "project")).FullName;
        foreach (string package in packages)
            Succeed(Source($"src/{package}"), "pack", "--no-build", "-p:ToolPlatforms=none", "-c", Configuration, "-o", Folder);
    }

    /// <summary>The packages.</summary>
    public string Folder => Path.Combine(_root, "feed");

    /// <summary>Where a package is built that is not what was built for the tests.</summary>
    public string[] BuildApart => ["-p:UseArtifactsOutput=true", $"-p:ArtifactsPath={Path.Combine(_root, "build")}"];

    /// <summary>An empty folder for somebody's project, with nothing of the checkout above it.</summary>
    public string Project { get; }

    /// <summary>Arguments by which a project is restored from the feed: what else it needs is not fetched where it is there already.</summary>
    public string[] Restore
    {
        get
        {
            string home = Environment.GetEnvironmentVariable("NUGET_PACKAGES")
                ?? Path.Combine(Environment.GetFolderPath(Environment.SpecialFolder.UserProfile), ".nuget", "packages");
            return
            [
                $"-p:RestoreAdditionalProjectSources={Folder}", $"-p:RestorePackagesPath={Path.Combine(_root, "packages")}", $"-p:RestoreFallbackFolders={home}",
            ];
        }
    }

    // Tests run from bin/CONFIGURATION/FRAMEWORK.
    private static string Configuration => Path.GetFileName(Path.GetDirectoryName(TestContext.CurrentContext.TestDirectory.TrimEnd(Path.DirectorySeparatorChar)))!;

    /// <summary>A folder of csharp/ in the checkout.</summary>
    public static string Source(string folder, [CallerFilePath] string here = "") =>
        Path.GetFullPath(Path.Combine(Path.GetDirectoryName(here)!, "..", "..", "..", "..", "csharp", folder));

    /// <summary>Whether a build failed since a compiler, a runtime or a linker of this platform is not there.</summary>
    public static bool IsNotToBeHad(string output) =>
        NotToBeHad.Any(reason => output.Contains(reason, StringComparison.Ordinal));

    /// <summary>What a program prints that has to end well.</summary>
    public static string Succeed(string folder, params string[] arguments)
    {
        (int exit, string output) = Run("dotnet", folder, arguments);
        Assert.That(exit, Is.Zero, output);
        return output;
    }

    /// <summary>Publishes the project into its folder "out" and gives what was printed; ignores the test where a part of the SDK is missing.</summary>
    public string Publish(string how)
    {
        (int exit, string output) = Run("dotnet", Project, ["publish", "--nologo", "-o", "out", .. Restore]);
        if (exit != 0 && IsNotToBeHad(output))
            Assert.Ignore($"{how}: the runtime's pack or a linker is not to be had");
        Assert.That(exit, Is.Zero, output);
        return output;
    }

    /// <summary>Runs a program in a folder.</summary>
    public static (int Exit, string Output) Run(string program, string folder, params string[] arguments)
    {
        var start = new ProcessStartInfo(program, arguments) { WorkingDirectory = folder, RedirectStandardOutput = true, RedirectStandardError = true };
        foreach (string name in new[] { "MSBuildSDKsPath", "MSBUILD_EXE_PATH", "MSBuildExtensionsPath", "VSTEST_CONNECTION_TIMEOUT" })
            start.Environment.Remove(name);
        using Process process = Process.Start(start)!;
        Task<string> errors = process.StandardError.ReadToEndAsync();
        string output = process.StandardOutput.ReadToEnd();
        process.WaitForExit();
        return (process.ExitCode, output + errors.Result);
    }

    public void Dispose() => Directory.Delete(_root, recursive: true);
}
