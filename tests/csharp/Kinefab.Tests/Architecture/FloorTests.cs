using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Runtime.CompilerServices;
using System.Text.RegularExpressions;
using Kinefab.Mechanisms;
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
    public void Names_EveryFile_PointDown()
    {
        Dictionary<string, HashSet<string>> types = Below.Keys.ToDictionary(layer => layer, layer => new HashSet<string>(Files(layer).SelectMany(f => Declared(File.ReadAllText(f)))));
        var faults = new List<string>();
        foreach (string own in Below.Keys)
        {
            foreach (string file in Files(own))
                faults.AddRange(Used(File.ReadAllText(file), types).Where(used => used != own && !Below[own].Contains(used)).Select(used => $"{own}/{Path.GetFileName(file)} uses {used}"));
        }

        Assert.That(types.Values, Is.All.Not.Empty);
        Assert.That(faults, Is.Empty);
    }

    [TestCase("using Kinefab.Joints;", "Joints")]
    [TestCase("using static Kinefab.Mechanisms.UnityFrames;", "Joints")]
    [TestCase("using Joint = Kinefab.Joints.Joint;", "Joints")]
    [TestCase("var text = Json.Invariant.Text(1);", "Json")]
    [TestCase("foreach (Dynamics.WorldJoint joint in all)", "Dynamics")]
    [TestCase("Kinefab.Joints.Joint joint = null;", "Joints")]
    [TestCase("return global::Kinefab.Joints.Joint.World;", "Joints")]
    [TestCase("new List<Joints.Joint>()", "Joints")]
    [TestCase("if (Joints.Count > Joints.Length)", "")]
    [TestCase("world.Joints.Joint()", "")]
    [TestCase("// as Joints.Joint has it", "")]
    [TestCase("/* Joints.Joint\n Joints.Joint */", "")]
    [TestCase("    /// <see cref=\"Joints.Joint\"/>", "")]
    public void Used_InCodeOrUsing_IsSeenAndInCommentsOrMembersNot(string code, string layer)
    {
        var types = new Dictionary<string, HashSet<string>> { ["Json"] = ["Invariant"], ["Dynamics"] = ["WorldJoint"], ["Joints"] = ["Joint", "UnityFrames"] };
        Assert.That(string.Join(" ", Used(code, types)), Is.EqualTo(layer));
    }

    private static string[] Files(string layer) => Directory.Exists(Path.Combine(Library(), layer))
        ? Directory.GetFiles(Path.Combine(Library(), layer), "*.cs", SearchOption.AllDirectories)
        : [];

    private static IEnumerable<string> Declared(string code) =>
        Regex.Matches(code, @"\b(?:class|struct|interface|enum|record) ([A-Z]\w*)").Select(m => m.Groups[1].Value);

    // A property may bear a layer's name: what follows the dot must be a type that the layer declares.
    private static IEnumerable<string> Used(string text, Dictionary<string, HashSet<string>> types)
    {
        string code = Regex.Replace(text, @"(?m)//.*$|/\*[\s\S]*?\*/", "");
        IEnumerable<string> usings = Regex.Matches(code, @"(?m)^using (?:static |\w+ = )?Kinefab\.(\w+)").Select(m => m.Groups[1].Value);
        IEnumerable<string> names = Regex.Matches(code, $@"(?<![\w.])(?:Kinefab\.)?({string.Join("|", types.Keys)})\.([A-Z]\w*)")
            .Where(m => types[m.Groups[1].Value].Contains(m.Groups[2].Value)).Select(m => m.Groups[1].Value);
        return usings.Concat(names).Distinct();
    }
}
