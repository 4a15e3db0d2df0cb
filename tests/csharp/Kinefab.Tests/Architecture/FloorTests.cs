using System.Collections.Generic;
using System.Linq;
using NUnit.Framework;

namespace Kinefab.Tests.Architecture;

/// <summary>The library's rooms: imports point down, no room is a hall, and no file of a room needs a file that needs it.</summary>
public sealed class FloorTests
{
    // The halls, from the ground up, and which others each may use.
    private static readonly Dictionary<string, string[]> Below = new()
    {
        ["Numerics"] = [],
        ["Json"] = [],
        ["Diagnostics"] = ["Json"],
        ["Reading"] = ["Json", "Numerics", "Diagnostics"],
        ["Document"] = ["Reading", "Json", "Numerics", "Diagnostics"],
        ["Validation"] = ["Document", "Reading", "Json", "Numerics", "Diagnostics"],
        ["Joints"] = ["Numerics"],
        ["Mechanisms"] = ["Joints", "Validation", "Document", "Json", "Numerics", "Diagnostics"],
        ["Dynamics"] = ["Mechanisms", "Joints", "Validation", "Document", "Json", "Numerics", "Diagnostics"],
        ["Kinematics"] = ["Mechanisms", "Joints", "Validation", "Document", "Json", "Numerics", "Diagnostics"],
        ["Collisions"] = ["Validation", "Document", "Json", "Numerics", "Diagnostics"],
        ["Advice"] = ["Collisions", "Kinematics", "Dynamics", "Mechanisms", "Joints", "Validation", "Document", "Json", "Numerics", "Diagnostics"],
    };

    // The rooms of a hall that has several, from the ground up.
    private static readonly string[] Rooms =
    [
        "Numerics", "Numerics/Lanes", "Numerics/Spatial", "Numerics/Sparse",
        "Document", "Document/Couplings", "Document/Joints", "Document/Rendering", "Document/Bodies", "Document/Analysis", "Document/Scene", "Document/Files",
        "Validation/Places", "Validation/Rules/Joints", "Validation/Rules", "Validation",
        "Mechanisms", "Mechanisms/Links",
        "Dynamics/Bodies", "Dynamics/Articulations", "Dynamics/Pgs/Projection", "Dynamics/Pgs", "Dynamics/Rattle/Islands", "Dynamics/Rattle/Records", "Dynamics/Rattle/Hinges", "Dynamics/Rattle/Lanes", "Dynamics/Rattle/ActiveSet", "Dynamics/Rattle/Energy", "Dynamics/Rattle/Steps", "Dynamics/Rattle/Consistency", "Dynamics/Rattle/Memory", "Dynamics/Rattle",
        "Dynamics/Worlds/Joints", "Dynamics/Worlds",
        "Kinematics/Mechanism", "Kinematics/Equations", "Kinematics/Solving", "Kinematics/Driving", "Kinematics/Mobility",
        "Advice/Model", "Advice/Runs", "Advice/Changes", "Advice/Trials", "Advice/Findings", "Advice",
    ];

    private const int MostFiles = 14;

    private static readonly House Library = House.OfLibrary();

    [Test]
    public void Rooms_All_HaveAPlace()
    {
        IEnumerable<string> rooms = Library.Files.Select(House.RoomOf).Where(room => room.Length > 0).Distinct();
        Assert.That(rooms.Where(room => !Below.ContainsKey(room) && !Rooms.Contains(room)), Is.Empty);
    }

    [Test]
    public void Rooms_All_HaveFewFiles() => Assert.That(
        Library.Files.GroupBy(House.RoomOf).Where(room => room.Count() > MostFiles).Select(room => $"{room.Key}: {room.Count()}"), Is.Empty);

    [Test]
    public void Imports_EveryFile_PointDown()
    {
        List<string> faults = [];
        int seen = 0;
        foreach ((string file, string used) in Library.Imports.Where(import => House.RoomOf(import.File).Length > 0 && House.RoomOf(import.Used).Length > 0))
        {
            seen++;
            string hall = House.HallOf(file);
            string other = House.HallOf(used);
            bool isDown = hall == other
                ? System.Array.IndexOf(Rooms, House.RoomOf(used)) <= System.Array.IndexOf(Rooms, House.RoomOf(file))
                : Below[hall].Contains(other);
            if (!isDown)
                faults.Add($"{file} uses {used}");
        }

        Assert.That(seen, Is.GreaterThan(Library.Files.Count), "imports are read at all");
        Assert.That(faults, Is.Empty);
    }

    [Test]
    public void Files_OfALibrary_StandInNoCircle() => Assert.That(Library.Circles().Select(circle => string.Join(", ", circle)), Is.Empty);

    [TestCase("new Kinefab.B.Below();", "B/Below.cs")]
    [TestCase("B.Below x = null;", "B/Below.cs")]
    [TestCase("var x = Below.One;", "B/Below.cs")]
    [TestCase("var x = new List<Below>();", "B/Below.cs")]
    [TestCase("1.Twice();", "B/Extensions.cs")]
    [TestCase("int Below = 1; Below++;", "")]
    [TestCase("string x = \"Below\"; // Below", "")]
    [TestCase("Whole x = null;", "B/Whole.cs")]
    public void Imports_OfCode_AreTheTypesThatItNames(string code, string used)
    {
        var house = House.Of(new Dictionary<string, string>
        {
            ["A/Above.cs"] = $"using System.Collections.Generic; using Kinefab.B; namespace Kinefab.A; class Above {{ void M() {{ {code} }} }}",
            ["B/Below.cs"] = "namespace Kinefab.B; class Below { public const int One = 1; }",
            ["B/Extensions.cs"] = "namespace Kinefab.B; static class Extensions { public static int Twice(this int n) => 2 * n; }",
            ["B/Whole.cs"] = "namespace Kinefab.B; partial class Whole { }",
            ["B/Whole.Loading.cs"] = "namespace Kinefab.B; partial class Whole { }",
        });
        Assert.That(house.Imports.Where(import => import.File == "A/Above.cs").Select(import => import.Used), Is.EqualTo(used.Length == 0 ? [] : new[] { used }));
    }

    [Test]
    public void Circles_OfFilesThatNameEachOther_AreFound()
    {
        var house = House.Of(new Dictionary<string, string>
        {
            ["A/One.cs"] = "namespace Kinefab.A; class One { Two two; }",
            ["A/Two.cs"] = "namespace Kinefab.A; class Two { Three three; }",
            ["A/Three.cs"] = "namespace Kinefab.A; class Three { One one; }",
            ["A/Four.cs"] = "namespace Kinefab.A; class Four { One one; }",
        });
        Assert.That(house.Circles().Select(circle => string.Join(" ", circle)), Is.EqualTo(["A/One.cs A/Three.cs A/Two.cs"]));
    }
}
