using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Runtime.CompilerServices;
using System.Text.RegularExpressions;
using NUnit.Framework;

namespace Kinefab.Tests.Architecture;

/// <summary>Namespaces only use those below them.</summary>
public sealed class FloorTests
{
    // Each namespace (a folder of the library) and what it may use.
    private static readonly Dictionary<string, string[]> Below = new()
    {
        ["Numerics"] = [],
        ["Diagnostics"] = [],
        ["Json"] = ["Numerics", "Diagnostics"],
        ["Document"] = ["Json", "Numerics", "Diagnostics"],
        ["Validation"] = ["Document", "Json", "Numerics", "Diagnostics"],
        ["Joints"] = ["Validation", "Document", "Numerics", "Diagnostics"],
        ["Dynamics"] = ["Joints", "Validation", "Document", "Numerics", "Diagnostics"],
        ["Kinematics"] = ["Joints", "Validation", "Document", "Numerics", "Diagnostics"],
        ["Advice"] = ["Kinematics", "Dynamics", "Joints", "Validation", "Document", "Json", "Numerics", "Diagnostics"],
    };

    private static string Library([CallerFilePath] string here = "") =>
        Path.GetFullPath(Path.Combine(Path.GetDirectoryName(here)!, "..", "..", "..", "..", "csharp", "src", "Kinefab"));

    [Test]
    public void Folders_All_HaveAFloor()
    {
        IEnumerable<string> folders = Directory.GetDirectories(Library()).Select(d => Path.GetFileName(d)!).Where(d => d is not ("bin" or "obj"));
        Assert.That(folders, Is.SubsetOf(Below.Keys));
    }

    [Test]
    public void Usings_EveryFile_PointDown()
    {
        var faults = new List<string>();
        foreach (string file in Below.Keys.Select(f => Path.Combine(Library(), f)).Where(Directory.Exists).SelectMany(f => Directory.GetFiles(f, "*.cs", SearchOption.AllDirectories)))
        {
            string own = Path.GetRelativePath(Library(), file).Split(Path.DirectorySeparatorChar)[0];
            foreach (Match match in Regex.Matches(File.ReadAllText(file), @"(?m)^using (?:static |\w+ = )?Kinefab\.(\w+)"))
            {
                string used = match.Groups[1].Value;
                if (used != own && !Below[own].Contains(used))
                    faults.Add($"{own}/{Path.GetFileName(file)} uses {used}");
            }
        }

        Assert.That(faults, Is.Empty);
    }
}
