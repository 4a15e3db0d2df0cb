using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Runtime.CompilerServices;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.NUnit;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;
using static Kinefab.NUnit.MechanismConstraints;

namespace Kinefab.Tests.Packaging;

/// <summary>The C# of the README, line by line, so that it compiles and runs.</summary>
[NonParallelizable]
public sealed class ReadmeTests
{
    [Test]
    public void Readme_Validate_Runs()
    {
        SceneReading reading = SceneFile.Load(Lever);
        SceneValidation? validation = reading.Document is { } document ? SceneValidator.Validate(document) : null;
        foreach (var finding in (validation?.Report ?? reading.Report).Diagnostics)
            Console.WriteLine($"{finding.Severity} {finding.Code} {finding.Pointer} line {finding.Line}: {finding.Message}");
        if (validation?.Scene is { } scene)                       // only a sound scene gets this far
            foreach (GameObject gameObject in scene.Document.GameObjects)
                Console.WriteLine($"{gameObject.Id}: {gameObject.Components.Count} components");
        Assert.That(validation?.Scene, Is.Not.Null);
    }

    [Test]
    public void Readme_Drive_Runs()
    {
        Mechanism mechanism = Mechanism.Create(ValidScene.Load(Lever));
        MechanismState state = mechanism.NewState();
        var solver = new PositionSolver(mechanism);
        DriveResult result = solver.Drive(state, "Lever/Crank:1", 60);   // degrees from the exported pose
        Console.WriteLine($"{result.Status}: the slider stands at {state.Pose("Lever/SliderD:1").Position} m");

        // At 30 + 60 degrees: x = sqrt(l^2 - r^2), and X is mirrored.
        Assert.That(state.Pose("Lever/SliderD:1").Position.X, Is.EqualTo(-Math.Sqrt((0.09 * 0.09) - (0.025 * 0.025))).Within(1e-9));

        DriveResult pulled = solver.Drag(state, "Lever/SliderD:1", point: Vector3d.Zero, target: new Vector3d(-0.1, 0.02, 0));
        foreach (int body in mechanism.Bodies)
            Console.WriteLine($"{body}: {state.Pose(body).Position}");   // in Unity: transform.SetPositionAndRotation
        Assert.That(pulled.Status, Is.EqualTo(DriveStatus.OutOfReach), "the slider cannot rise");
        Assert.That(state.Pose("Lever/SliderD:1").Position.X, Is.EqualTo(-0.1).Within(1e-6));
    }

    [Test]
    public void Readme_Constraints_Hold()
    {
        string before = Directory.GetCurrentDirectory();
        Directory.SetCurrentDirectory(Path.GetFullPath(Path.Combine(Path.GetDirectoryName(Lever)!, "..", "..", "csharp", "examples", "LeverTests")));
        try
        {
            string lever = "lever.kinefab";
            Assert.That(lever, Is.ValidScene);
            Assert.That(lever, Has.Mobility(1));
            Assert.That(lever, Drives("Lever/Crank:1").From(0).To(360).Moving("Lever/SliderD:1").By(0.05).Within(1e-6));
            Assert.That(lever, Matches.Trajectory("lever.motion.json").Within(1e-6));
        }
        finally
        {
            Directory.SetCurrentDirectory(before);
        }
    }

    [Test]
    public void Readme_Simulate_Runs()
    {
        World world = World.Create(ValidScene.Load(Lever), SolverKind.Unity);
        for (int i = 0; i < 100; i++)
            world.Step(0.02);
        Console.WriteLine($"the lever stands at {world.Joint("Lever/Crank:1").Coordinate(Coordinate.Angle)} degrees");
        Assert.That(world.Joints, Has.Count.EqualTo(4));
    }

    [Test]
    public void Readme_CSharp_StandsInThisFile()
    {
        HashSet<string> here = File.ReadAllLines(ThisFile()).Select(Plain).ToHashSet();
        bool inside = false;
        var missing = new List<string>();
        foreach (string line in File.ReadAllLines(Path.Combine(Root(), "README.md")))
        {
            if (line.StartsWith("```", StringComparison.Ordinal))
                inside = line == "```csharp";
            else if (inside && !here.Contains(Plain(line)))
                missing.Add(line);
        }

        Assert.That(missing, Is.Empty);
    }

    private static string Plain(string line) => line.Replace("out/lever.kinefab", "LEVER", StringComparison.Ordinal).Replace("\"LEVER\"", "Lever", StringComparison.Ordinal).Trim();

    private static string Lever => Path.Combine(Root(), "fixtures", "lever", "lever.kinefab");

    private static string Root() => Path.Combine(Path.GetDirectoryName(ThisFile())!, "..", "..", "..", "..");

    private static string ThisFile([CallerFilePath] string path = "") => path;
}
