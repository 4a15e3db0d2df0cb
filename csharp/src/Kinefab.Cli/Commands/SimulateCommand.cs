using System;
using System.CommandLine;
using System.IO;
using Kinefab.Cli.Motion;
using Kinefab.Cli.Simulation;
using Kinefab.Dynamics;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab simulate FILE --seconds S [--step DT] [--solver unity|exact] [-o traj.json|csv] [--drive JOINT=VALUE...].</summary>
internal static class SimulateCommand
{
    private const int WrongUsage = 2;

    internal static Command Create()
    {
        Argument<string> file = SceneArguments.File();
        Option<double?> seconds = TypedOptions.Positive("--seconds", "How long to simulate.");
        seconds.Required = true;
        Option<double?> step = TypedOptions.Positive("--step", "Time step in seconds; default: the scene's fixedTimestep.");
        Option<SolverKind> solver = TypedOptions.Solver();
        Option<string?> output = TypedOptions.Trajectory();
        var drives = new Option<string[]>("--drive")
        {
            Description = "JOINT[.COORDINATE]=VALUE[/s]: drive a joint to a value or, with /s, at a speed; degrees or metres. JOINT is the id or name of its GameObject.",
        };
        var command = new Command("simulate", "Run a scene and say what its joints did.") { file, seconds, step, solver, output, drives };
        command.SetAction(parsed => Run(
            parsed.GetRequiredValue(file),
            parsed.GetRequiredValue(seconds)!.Value,
            parsed.GetValue(step),
            parsed.GetValue(solver),
            parsed.GetValue(output),
            parsed.GetValue(drives) ?? []));
        return command;
    }

    private static int Run(string file, double seconds, double? step, SolverKind kind, string? output, string[] drives)
    {
        LoadedScene loaded = LoadedScene.Load(file, strict: false);
        ReportWriter.WriteLines(file, loaded.Report, Console.Error);
        if (loaded.Scene is null)
            return loaded.ExitCode;
        World world = World.Create(loaded.Scene, kind);
        ReportWriter.WriteLines(file, world.Findings, Console.Error);
        foreach (string text in drives)
        {
            if (DriveSetting.Apply(world, loaded.Scene, text) is string fault)
            {
                Console.Error.WriteLine($"--drive {text}: {fault}");
                return WrongUsage;
            }
        }

        double dt = step ?? loaded.Scene.Document.Physics.FixedTimestep;
        long steps = Math.Max(1, (long)Math.Round(seconds / dt));
        var summary = new RunSummary(world, loaded.Scene);
        Recording? recording = output is null ? null : new Recording(world, loaded.Scene, kind, dt);
        var progress = new Progress(steps);
        for (long i = 1; i <= steps; i++)
        {
            world.Step(dt);
            summary.Note();
            recording?.Note();
            progress.Report(i);
        }

        summary.Write(Console.Out, kind, steps, dt);
        return Save(recording, output) && world.Overflows == 0 ? 0 : 1;
    }

    private static bool Save(Recording? recording, string? output)
    {
        if (recording is null || output is null)
            return true;
        try
        {
            TrajectoryFile.Save(recording.Trajectory, output);
            return true;
        }
        catch (Exception e) when (e is IOException or UnauthorizedAccessException or NotSupportedException)
        {
            Console.Error.WriteLine($"error TARGET_UNWRITABLE: {output} cannot be written: {e.Message}");
            return false;
        }
    }
}
