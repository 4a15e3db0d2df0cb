using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Runtime.CompilerServices;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.NUnit;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;
using static Kinefab.NUnit.MechanismConstraints;

namespace Kinefab.Tests.Packaging;

/// <summary>The C# of the README and the guides, line by line, so that it compiles and runs.</summary>
[NonParallelizable]
public sealed class ReadmeTests
{
    [Test]
    public void Readme_Validate_Runs()
    {
        ValidScene scene = ValidScene.Load(Lever);   // errors are thrown all at once, each with place and remedy
        foreach (Diagnostic warning in scene.Report.Diagnostics)
            Console.WriteLine(warning);
        foreach (GameObject gameObject in scene.Document.GameObjects)
            Console.WriteLine(gameObject);
        Assert.That(scene.Report.HasErrors, Is.False);
    }

    [Test]
    public void Readme_Drive_Runs()
    {
        Mechanism mechanism = Mechanism.Load(Lever);
        SweepResult turn = mechanism.Sweep("Crank:1", 0, 360, 72);       // degrees from the exported pose
        Console.WriteLine($"the slider's stroke is {turn["Mate:1.x"].Max() - turn["Mate:1.x"].Min()} m; {turn.Pose("BarC:1", 18)}");
        Assert.That(turn["Mate:1.x"].Max() - turn["Mate:1.x"].Min(), Is.EqualTo(0.05).Within(1e-4));

        MechanismState state = mechanism.NewState();
        var solver = new PositionSolver(mechanism);
        DriveResult result = solver.Drive(state, "Crank:1", 60);         // limits and dead points are results, not exceptions
        Console.WriteLine($"{result}: the slider stands at {state.Pose("SliderD:1")}");

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
            Assert.That(lever, Drives("Shaft").From(0).To(360).Moving("Slide").By(0.05).Within(1e-6));
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
        World world = World.Load(Lever, SolverKind.Unity);
        var crank = (WorldHingeJoint)world.Joint("Crank:1");
        crank.Settings = crank.Settings with { UseLimits = true, Limits = crank.Settings.Limits with { Min = -10, Max = 80 } };
        WorldSnapshot start = world.Snapshot();
        RunResult run = world.Run(seconds: 2, until: w => crank.IsAtLimit, record: ["Crank:1"]);
        Console.WriteLine($"the lever stands at {run["Crank:1"][^1]} degrees after {run.Times[^1]} s");
        world.Restore(start);                                            // and the same calls give the same bits again
        Assert.That(world.Time, Is.Zero);
        Assert.That(world.Joints, Has.Count.EqualTo(4));
    }

    [Test]
    public void Readme_CSharp_StandsInThisFile()
    {
        HashSet<string> here = File.ReadAllLines(ThisFile()).Select(Plain).ToHashSet();
        bool inside = false;
        var missing = new List<string>();
        string[] pages = [Path.Combine(Root(), "README.md"), .. Directory.GetFiles(Path.Combine(Root(), "guides"), "*.md")];
        foreach (string line in pages.SelectMany(File.ReadAllLines))
        {
            if (line.StartsWith("```", StringComparison.Ordinal))
                inside = line == "```csharp";
            else if (inside && !here.Contains(Plain(line)))
                missing.Add(line);
        }

        Assert.That(missing, Is.Empty);
    }

    [Test]
    public void Readme_CopiedFiles_AreCopiedSoInTheExample()
    {
        const string copies = "<None Include=\"lever.*\" CopyToOutputDirectory=\"PreserveNewest\" />";
        foreach (string file in new[] { "csharp/examples/LeverTests/LeverTests.csproj", "guides/ci.md", "csharp/src/Kinefab.NUnit/README.md" })
            Assert.That(File.ReadAllText(Path.Combine(Root(), file)), Does.Contain(copies), file);
    }

    private static string Plain(string line) => line.Replace("out/lever.kinefab", "LEVER", StringComparison.Ordinal).Replace("\"LEVER\"", "Lever", StringComparison.Ordinal).Trim();

    private static string Lever => Path.Combine(Root(), "fixtures", "lever", "lever.kinefab");

    private static string Root() => Path.Combine(Path.GetDirectoryName(ThisFile())!, "..", "..", "..", "..");

    private static string ThisFile([CallerFilePath] string path = "") => path;
}
