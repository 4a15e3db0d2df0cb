using System;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Runtime.InteropServices;
using Kinefab.Tests.Packaging;
using NUnit.Framework;

namespace Kinefab.Tests.UnityPackage;

/// <summary>
/// The package's runtime published trimmed, and as machine code alone: as near as one comes to IL2CPP without Unity. The library goes without what
/// nobody calls; what Unity's own reflection reaches, the package's components, is kept as Unity keeps it.
/// </summary>
[NonParallelizable]
public sealed class PublishedPackageTests
{
    private const string Code = """
        using System;
        using System.Globalization;
        using System.Linq;

        foreach (string path in args)
            Console.WriteLine(string.Join(" ", Kinefab.Tests.UnityPackage.PackageRun.Numbers(path).Select(v => BitConverter.DoubleToInt64Bits(v).ToString("x16", CultureInfo.InvariantCulture))));
        """;

    [TestCase("PublishTrimmed")]
    [TestCase("PublishAot")]
    public void Package_Published_HasTheSameBits(string how)
    {
        using var feed = new PackageFeed("Kinefab");
        string tests = Path.GetFullPath(Path.Combine(PackageFeed.Source("."), "..", "tests", "csharp"));
        File.WriteAllText(Path.Combine(feed.Project, "Program.cs"), Code);
        File.WriteAllText(Path.Combine(feed.Project, "play.csproj"), $"""
            <Project Sdk="Microsoft.NET.Sdk">
              <PropertyGroup>
                <OutputType>Exe</OutputType>
                <TargetFramework>net10.0</TargetFramework>
                <RuntimeIdentifier>{RuntimeInformation.RuntimeIdentifier}</RuntimeIdentifier>
                <{how}>true</{how}>
                <SelfContained>true</SelfContained>
                <InvariantGlobalization>true</InvariantGlobalization>
                <DefineConstants>$(DefineConstants);{string.Join(';', UnityEditors.Defines("6000.7"))};ENABLE_LEGACY_INPUT_MANAGER</DefineConstants>
              </PropertyGroup>
              <ItemGroup>
                <PackageReference Include="Kinefab" Version="0.1.0" />
                <Compile Include="{PackageFeed.Source("unity/com.kinefab/Runtime")}/**/*.cs" />
                <Compile Include="{tests}/UnityStandIns/UnityEngine/*.cs" />
                <Compile Include="{tests}/Kinefab.Tests/UnityPackage/PackageRun.cs" />
                <TrimmerRootAssembly Include="play" />
              </ItemGroup>
            </Project>
            """);
        string output = feed.Publish(how);
        Assert.That(output.Split('\n').Where(l => l.Contains("com.kinefab", StringComparison.Ordinal) && (l.Contains("IL2", StringComparison.Ordinal) || l.Contains("IL3", StringComparison.Ordinal))), Is.Empty, "no reflection");
        string[] scenes = [PlayedMechanism.Lever, PlayedMechanism.Full("mechanisms/M48.kinefab")];
        (int ended, string printed) = PackageFeed.Run(Path.Combine(feed.Project, "out", "play"), feed.Project, scenes);
        string[] here = [.. scenes.Select(scene => string.Join(" ", PackageRun.Numbers(scene).Select(v => BitConverter.DoubleToInt64Bits(v).ToString("x16", CultureInfo.InvariantCulture))))];
        Assert.That(ended, Is.Zero, printed);
        Assert.That(printed.Split('\n', StringSplitOptions.RemoveEmptyEntries), Is.EqualTo(here));
    }
}
