using System;
using System.CommandLine;
using System.Globalization;
using System.Linq;
using Kinefab.Cli.Motion;
using Kinefab.Cli.Simulation;
using Kinefab.Diagnostics;
using Kinefab.Dynamics;
using Kinefab.Kinematics;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab simulate FILE --seconds S [--step DT] [--solver unity|exact] [-o traj.json|csv] [--drive JOINT=VALUE...].</summary>
internal static class SimulateCommand
{
    internal static Command Create()
    {
        Argument<string> file = SceneArguments.File();
        Option<double?> seconds = TypedOptions.Positive("--seconds", $"How long to simulate; at most {TypedOptions.MostSteps} steps.");
        seconds.Required = true;
        Option<double?> step = TypedOptions.Positive("--step", "Time step in seconds; default: the scene's fixedTimestep.");
        Option<SolverKind> solver = TypedOptions.Solver();
        Option<string?> output = TypedOptions.Trajectory();
        var drives = new Option<string[]>("--drive")
        {
            Description = "JOINT[.COORDINATE]=VALUE[/s]: drive a joint to a value or, with /s, at a speed; degrees or metres. JOINT is the id or name of its GameObject, with [COMPONENT] behind it where one object carries several joints.",
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
        double dt = step ?? loaded.Scene.Document.Physics.FixedTimestep;
        double count = Math.Max(1, Math.Round(seconds / dt));
        if (count > TypedOptions.MostSteps)
            return WrongUsage.Refuse(string.Create(CultureInfo.InvariantCulture, $"--seconds {seconds} at {dt} s a step makes {count} steps; at most {TypedOptions.MostSteps} are run. Give fewer seconds or a longer --step."));
        World world = World.Create(loaded.Scene, kind);
        int told = world.Findings.Diagnostics.Count;
        ReportWriter.WriteLines(file, world.Findings, Console.Error);
        Mechanism? mechanism = drives.Length == 0 && output is null ? null : Mechanism.Create(loaded.Scene);
        foreach (string text in drives)
        {
            if (DriveSetting.Apply(world, mechanism!, text) is string fault)
                return WrongUsage.Refuse($"--drive {text}: {fault}");
        }

        var steps = (int)count;
        if (output is not null && TrajectorySize.Fault(steps, world.Bodies.Count, mechanism!.Coordinates.Count) is string excess)
            return WrongUsage.Refuse($"--output {output}: {excess} Give fewer seconds or a longer --step.");
        Report target = output is null ? Report.Empty : TargetFile.Check(output);
        if (target.HasErrors)
            return Fail(file, target);
        var summary = new RunSummary(world, loaded.Scene);
        Recording? recording = output is null ? null : new Recording(world, mechanism!, kind, dt);
        var progress = new Progress(steps);
        for (int i = 1; i <= steps; i++)
        {
            world.Step(dt);
            summary.Note();
            recording?.Note();
            progress.Report(i);
        }

        progress.End();
        ReportWriter.WriteLines(file, new Report(world.Findings.Diagnostics.Skip(told).ToArray()), Console.Error);
        summary.Write(Console.Out, kind, steps, dt);
        Report saved = recording is null ? Report.Empty : TrajectoryFile.Save(recording.Trajectory, output!);
        return saved.HasErrors ? Fail(file, saved) : world.Stops == 0 ? 0 : 1;
    }

    private static int Fail(string file, Report report)
    {
        ReportWriter.WriteLines(file, report, Console.Error);
        return 1;
    }
}
