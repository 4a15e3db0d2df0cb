using System;
using System.CommandLine;
using System.Globalization;
using Kinefab.Cli.Motion;
using Kinefab.Cli.Simulation;
using Kinefab.Diagnostics;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Validation;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab simulate FILES --seconds S [--step DT] [--solver unity|exact] [-o traj.json|csv] [--drive JOINT=VALUE...] [--json] [--junit FILE].</summary>
internal static class SimulateCommand
{
    internal static Command Create()
    {
        var scenes = new SceneArguments();
        Option<double?> seconds = TypedOptions.Positive("--seconds", $"How long to simulate; at most {TypedOptions.MostSteps} steps.");
        seconds.Required = true;
        Option<double?> step = TypedOptions.Positive("--step", "Time step in seconds; default: the scene's fixedTimestep.");
        Option<SolverKind> solver = TypedOptions.Solver();
        Option<string?> output = TypedOptions.Trajectory();
        var drives = new Option<string[]>("--drive")
        {
            Description = "JOINT[.COORDINATE]=VALUE[/s]: drive a joint to a value or, with /s, at a speed; degrees or metres. JOINT is what the CAD program calls it, or the id or name of its GameObject, with [COMPONENT] behind it where one object carries several joints.",
        };
        var command = new Command("simulate", "Run a scene and say what its joints did.") { seconds, step, solver, output, drives };
        scenes.AddTo(command);
        command.SetAction(parsed =>
        {
            SceneBatch batch = scenes.Of(parsed);
            string? target = parsed.GetValue(output);
            if (batch.FaultOfSingle("--output", target) is string fault)
                return WrongUsage.Refuse(fault);
            var run = new Run(parsed.GetRequiredValue(seconds)!.Value, parsed.GetValue(step), parsed.GetValue(solver), target, parsed.GetValue(drives) ?? [], batch.IsJson);
            return batch.Run(run.Of);
        });
        return command;
    }

    private sealed record Run(double Seconds, double? Step, SolverKind Kind, string? Output, string[] Drives, bool IsJson)
    {
        internal SceneOutcome Of(string file)
        {
            LoadedScene loaded = LoadedScene.Load(file, strict: false);
            Tell(file, loaded.Report);
            if (loaded.Scene is null)
                return new SceneOutcome(loaded.ExitCode, loaded.Report);
            double dt = Step ?? loaded.Scene.Document.Physics.FixedTimestep;
            double count = Math.Max(1, Math.Round(Seconds / dt));
            if (count > TypedOptions.MostSteps)
                return SceneOutcome.Refused(loaded.Report, string.Create(CultureInfo.InvariantCulture, $"--seconds {Seconds} at {dt} s a step makes {count} steps; at most {TypedOptions.MostSteps} are run. Give fewer seconds or a longer --step."));
            World world = World.Create(loaded.Scene, Kind);
            Tell(file, world.Findings);
            Report before = loaded.Report.Concat(world.Findings);
            Mechanism? mechanism = Drives.Length == 0 && Output is null ? null : Mechanism.Create(loaded.Scene);
            foreach (string text in Drives)
            {
                if (DriveSetting.Apply(world, mechanism!, text) is string fault)
                    return SceneOutcome.Refused(before, $"--drive {text}: {fault}");
            }

            var steps = (int)count;
            if (Output is not null && TrajectorySize.Fault(steps, world.Bodies.Count, mechanism!.Coordinates.Count) is string excess)
                return SceneOutcome.Refused(before, $"--output {Output}: {excess} Give fewer seconds or a longer --step.");
            Report target = Output is null ? Report.Empty : TargetFile.Check(Output);
            if (target.HasErrors)
                return Fail(file, before, target);
            return Move(file, loaded.Scene, world, mechanism, steps, dt, before);
        }

        private SceneOutcome Move(string file, ValidScene scene, World world, Mechanism? mechanism, int steps, double dt, Report before)
        {
            var summary = new RunSummary(world, scene, Kind, steps, dt);
            Recording? recording = Output is null ? null : new Recording(world, mechanism!, Kind, dt);
            var progress = new Progress(steps);
            RunResult run = world.Run(
                steps * dt,
                step: dt,
                until: _ =>
                {
                    summary.Note();
                    recording?.Note();
                    return false;
                },
                progress: progress);
            progress.End();
            Tell(file, run.Findings);
            if (!IsJson)
                summary.Write(Console.Out);
            Report found = before.Concat(run.Findings);
            Report saved = recording is null ? Report.Empty : TrajectoryFile.Save(recording.Trajectory, Output!);
            if (saved.HasErrors)
                return Fail(file, found, saved, summary);
            return world.Stops == 0
                ? new SceneOutcome(0, found, Fields: summary.WriteJson)
                : new SceneOutcome(1, found, "the solver could not follow", summary.WriteJson);
        }

        private void Tell(string file, Report report)
        {
            if (!IsJson)
                ReportWriter.WriteLines(file, report, Console.Error);
        }

        private SceneOutcome Fail(string file, Report before, Report report, RunSummary? summary = null)
        {
            Tell(file, report);
            return new SceneOutcome(1, before.Concat(report), Fields: summary is null ? null : summary.WriteJson);
        }
    }
}
