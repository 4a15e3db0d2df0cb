using System;
using System.IO;
using System.IO.Compression;
using System.Linq;
using System.Reflection.PortableExecutable;
using NUnit.Framework;

namespace Kinefab.Tests.Packaging;

/// <summary>
/// A user's own test project, csharp/examples/LeverTests, as a user has it: in a folder of its own, with the packages
/// from a feed. What it needs besides ours comes from where this project's own packages came from.
/// </summary>
public sealed class LeverTestsTests
{
    [TestCase("4.1.0")]
    [TestCase("5.0.0")]
    public void LeverTests_FromThePackages_PassInDotnetTest(string nunit)
    {
        using var feed = new PackageFeed("Kinefab", "Kinefab.NUnit");
        foreach (string file in Directory.GetFiles(PackageFeed.Source("examples/LeverTests")))
            File.Copy(file, Path.Combine(feed.Project, Path.GetFileName(file)));
        string project = Path.Combine(feed.Project, "LeverTests.csproj");
        File.WriteAllText(project, File.ReadAllText(project).Replace("\"NUnit\" Version=\"5.0.0\"", $"\"NUnit\" Version=\"{nunit}\"", StringComparison.Ordinal));
        string output = PackageFeed.Succeed(feed.Project, ["test", "--nologo", .. feed.Restore, "--logger", "console;verbosity=normal"]);
        Assert.That(File.ReadAllText(Directory.GetFiles(feed.Project, "LeverTests.deps.json", SearchOption.AllDirectories)[0]), Does.Contain($"\"NUnit/{nunit}\""));
        Assert.That(output, Does.Match(@"Passed:\s+10\b|Total tests: 10\s+Passed: 10"), output);
    }

    [TestCase("Kinefab", "lib/net10.0/Kinefab.dll", "lib/netstandard2.1/Kinefab.dll", "README.md", "THIRD-PARTY-NOTICES.md")]
    [TestCase("Kinefab.NUnit", "lib/net8.0/Kinefab.NUnit.dll", "lib/net8.0/Kinefab.NUnit.xml", "README.md", "THIRD-PARTY-NOTICES.md")]
    [TestCase("Kinefab.Cli", "tools/net10.0/any/dotnet-kinefab.dll", "README.md", "THIRD-PARTY-NOTICES.md")]
    public void Package_OfEach_HoldsWhatItPromises(string package, params string[] files)
    {
        using var feed = new PackageFeed(package);
        using ZipArchive archive = ZipFile.OpenRead(Directory.GetFiles(feed.Folder, $"{package}.*.nupkg").Single(file => !file.EndsWith(".snupkg", StringComparison.Ordinal)));
        Assert.That(files, Is.SubsetOf(archive.Entries.Select(entry => entry.FullName)));
        Assert.That(Directory.GetFiles(feed.Folder, "*.snupkg"), Has.Length.EqualTo(package == "Kinefab.Cli" ? 0 : 1));
        using var readme = new StreamReader(archive.GetEntry("README.md")!.Open());
        Assert.That(readme.ReadLine(), Is.EqualTo(package == "Kinefab.Cli" ? "# dotnet kinefab" : $"# {package}"), "each has a page of its own");
    }

    [Test]
    public void Constraints_OfACloneBehindALink_DependOnTheLibrary()
    {
        using var feed = new PackageFeed();
        string link = Path.Combine(feed.Project, "clone");
        Directory.CreateSymbolicLink(link, PackageFeed.Source(".."));
        PackageFeed.Succeed(feed.Project, ["restore", Path.Combine(link, "csharp", "src", "Kinefab.NUnit"), .. feed.BuildApart]);
        string restored = Path.Combine(feed.BuildApart[1].Split('=')[1], "obj", "Kinefab.NUnit", "project.assets.json");
        Assert.That(File.ReadAllText(restored), Does.Contain("\"Kinefab/0.1.0\""));
    }

    [TestCase("Kinefab")]
    [TestCase("Kinefab.NUnit")]
    [TestCase("Kinefab.Cli")]
    public void Package_BeingPacked_IsNotAnalysedAgain(string package) =>
        Assert.That(PackageFeed.Run("dotnet", PackageFeed.Source($"src/{package}"), "msbuild", "-getProperty:RunAnalyzers", "-p:_IsPacking=true").Output.Trim(), Is.EqualTo("false"));

    [Test]
    public void Tool_PackedForThisPlatform_IsMachineCodeAndRuns()
    {
        using var feed = new PackageFeed();
        (int exit, string output) = PackageFeed.Run("dotnet", PackageFeed.Source("src/Kinefab.Cli"), ["pack", "-c", "Release", "-o", feed.Folder, .. feed.BuildApart]);
        if (exit != 0 && PackageFeed.IsNotToBeHad(output))
            Assert.Ignore("the compiler of ReadyToRun code is not to be had");
        Assert.That(exit, Is.Zero, output);
        string platform = Directory.GetFiles(feed.Folder).Select(Path.GetFileName).Single(name => name is not ("Kinefab.Cli.0.1.0.nupkg" or "Kinefab.Cli.any.0.1.0.nupkg"))!;
        using ZipArchive archive = ZipFile.OpenRead(Path.Combine(feed.Folder, platform));
        foreach (string dll in new[] { "Kinefab.dll", "dotnet-kinefab.dll" })
        {
            using var bytes = new MemoryStream();
            using (Stream entry = archive.Entries.Single(e => e.Name == dll).Open())
                entry.CopyTo(bytes);
            bytes.Position = 0;
            using var portable = new PEReader(bytes);
            Assert.That(portable.PEHeaders.CorHeader!.ManagedNativeHeaderDirectory.Size, Is.Positive, $"{dll} has code for its platform");
        }

        PackageFeed.Succeed(feed.Project, "tool", "install", "Kinefab.Cli", "--tool-path", "tools", "--add-source", feed.Folder, "--version", "0.1.0");
        Assert.That(
            PackageFeed.Run(Path.Combine(feed.Project, "tools", "dotnet-kinefab"), feed.Project, "validate", Path.Combine(PackageFeed.Source("examples/LeverTests"), "lever.kinefab")).Exit,
            Is.Zero);
    }
}
