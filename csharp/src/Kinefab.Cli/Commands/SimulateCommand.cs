using System;
using System.Collections.Generic;
using System.CommandLine;
using System.Globalization;
using System.Linq;
using Kinefab.Cli.Motion;
using Kinefab.Cli.Simulation;
using Kinefab.Diagnostics;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Validation;

namespace Kinefab.Cli.Commands;

/// <summary>
/// dotnet kinefab simulate FILES --seconds S [--step DT] [--solver unity|exact] [-o traj.json|csv] [--drive JOINT=VALUE...] [--record FILE [--every N] |
/// --replay FILE] [--json] [--junit FILE].
/// </summary>
internal static class SimulateCommand
{
    internal static Command Create()
    {
        var scenes = new SceneArguments();
        Option<double?> seconds = TypedOptions.Positive("--seconds", $"How long to simulate, rounded to whole steps: one at least, and at most {TypedOptions.MostSteps}. Required, but for --replay.");
        Option<double?> step = TypedOptions.Positive("--step", $"Time step in seconds, at least {TypedOptions.ShortestStep.ToString(CultureInfo.InvariantCulture)} and no longer than --seconds; default: the scene's fixedTimestep.");
        Option<SolverKind> solver = TypedOptions.Solver();
        Option<string?> output = TypedOptions.Trajectory();
        var drives = new Option<string[]>("--drive")
        {
            Description = $"JOINT[.COORDINATE]=VALUE[/s]: drive a joint to a value or, with /s, at a speed; degrees or metres, at most {MechanismCoordinate.FarthestDegrees} or {MechanismCoordinate.FarthestMetres} (a second). May be repeated, once for each coordinate. JOINT is what the source calls it, or the id or name of its GameObject, with [COMPONENT] behind it where one object carries several joints.",
        };
        Option<string?> record = TypedOptions.File("--record", "Write down the run, NAME.kfrec: what went in, and a hash of the state after its steps.");
        Option<int> every = TypedOptions.Count("--every", "Steps between two hashes of --record.", most: TypedOptions.MostSteps, standard: 1);
        Option<string?> replay = TypedOptions.File("--replay", "Make a recorded run again, with its seconds, step, solver and drives, and name the first step that differs (exit 1).");
        var command = new Command("simulate", "Run a scene and say what its joints did.") { seconds, step, solver, output, drives, record, every, replay };
        command.Validators.Add(result =>
        {
            bool isReplay = result.GetResult(replay) is not null;
            if (!isReplay && result.GetResult(seconds) is null)
                result.AddError("--seconds is required: how long to simulate.");
            foreach (Option given in new Option[] { seconds, step, solver, drives, record, every })
            {
                if (isReplay && result.GetResult(given) is { Implicit: false })
                    result.AddError($"{given.Name} cannot be given beside --replay, whose file says how to run.");
            }

            if (!isReplay && result.GetResult(record) is null && result.GetResult(every) is { Implicit: false })
                result.AddError("--every says how often --record notes a hash, and there is no --record.");
        });
        scenes.AddTo(command);
        command.SetAction(parsed =>
        {
            SceneBatch batch = scenes.Of(parsed);
            string? target = parsed.GetValue(output);
            string? recordTo = parsed.GetValue(record);
            string? replayOf = parsed.GetValue(replay);
            string? wrong = batch.FaultOfSingle("--output", target) ?? batch.FaultOfSingle("--record", recordTo) ?? batch.FaultOfSingle("--replay", replayOf)
                ?? batch.FaultOfTarget("--output", target) ?? batch.FaultOfTarget("--record", recordTo)
                ?? batch.FaultOfSame(("--replay", replayOf), ("--record", recordTo), ("--output", target));
            if (wrong is not null)
                return WrongUsage.Refuse(wrong);
            var run = new Run(parsed.GetValue(seconds) ?? 0, parsed.GetValue(step), parsed.GetValue(solver), target, parsed.GetValue(drives) ?? [], batch.IsJson)
            {
                RecordTo = recordTo,
                Every = parsed.GetValue(every),
                ReplayOf = replayOf,
            };
            return batch.Run(run.Of);
        });
        return command;
    }

    private sealed record Run(double Seconds, double? Step, SolverKind Kind, string? Output, string[] Drives, bool IsJson)
    {
        internal string? RecordTo { get; init; }

        internal int Every { get; init; } = 1;

        internal string? ReplayOf { get; init; }

        private RunRecord? Replayed { get; init; }

        internal SceneOutcome Of(string file)
        {
            if ((RecordTo ?? ReplayOf) is not null && file == LoadedScene.StandardInput)
                return SceneOutcome.Refused(Report.Empty, "--record and --replay need a file: they name the scene by its bytes.");
            if (ReplayOf is null)
                return Simulate(file);
            (RunRecord? replayed, Report report) = RecordFile.Load(ReplayOf);
            if (replayed is null)
                return Fail(file, Report.Empty, report);
            return (this with { Replayed = replayed, Kind = replayed.Solver, Step = replayed.Step, Seconds = replayed.Steps * replayed.Step, Drives = [.. replayed.Drives] }).Simulate(file);
        }

        private SceneOutcome Simulate(string file)
        {
            LoadedScene loaded = LoadedScene.Load(file, strict: false);
            Tell(file, loaded.Report);
            if (loaded.Scene is null)
                return new SceneOutcome(loaded.ExitCode, loaded.Report);
            double dt = Step ?? loaded.Scene.Document.Physics.FixedTimestep;
            // As floats, which Unity's numbers are: 0.1 s hold a step of 0.1f, which is a little longer.
            if (Replayed is null && (float)dt > (float)Seconds)
                return SceneOutcome.Refused(loaded.Report, string.Create(CultureInfo.InvariantCulture, $"--seconds {Seconds} is less than one step of {dt} s. Give more seconds or a shorter --step."));
            double count = Replayed?.Steps ?? Math.Round(Seconds / dt);
            if (count > TypedOptions.MostSteps)
                return SceneOutcome.Refused(loaded.Report, string.Create(CultureInfo.InvariantCulture, $"--seconds {Seconds} at {dt} s a step makes {count} steps; at most {TypedOptions.MostSteps} are run. Give fewer seconds or a longer --step."));
            if (dt < TypedOptions.ShortestStep)
                return SceneOutcome.Refused(loaded.Report, string.Create(CultureInfo.InvariantCulture, $"A step of {dt} s is shorter than {TypedOptions.ShortestStep} s: what a body moves in it is less than the numbers of its place tell, and the rest is noise. Give a longer --step."));
            if (!double.IsFinite(count * dt))
                return SceneOutcome.Refused(loaded.Report, string.Create(CultureInfo.InvariantCulture, $"--seconds {Seconds} at {dt} s a step make no finite time."));
            RunRecord? plan = null;
            if ((RecordTo ?? ReplayOf) is not null)
            {
                string hash = RecordFile.HashOfScene(file);
                plan = Replayed ?? new RunRecord(hash, Kind, dt, (int)count, Drives, Every, []);
                if (plan.Scene != hash)
                    return Fail(file, loaded.Report, new Report([Diagnostic.Of(DiagnosticCodes.RecordingOtherScene, "", ("path", ReplayOf!), ("scene", file))]));
            }

            World world = World.Create(loaded.Scene, Kind);
            Tell(file, world.Findings);
            Report before = loaded.Report.Concat(world.Findings);
            Mechanism? mechanism = Drives.Length == 0 && Output is null ? null : Mechanism.Create(loaded.Scene);
            var drives = new List<DriveSetting>();
            foreach (string text in Drives)
            {
                DriveSetting? drive = DriveSetting.Read(world, mechanism!, text, out string fault);
                if (drive is null)
                    return RefuseDrive(file, before, text, fault);
                if (drives.Find(other => other.Coordinate == drive.Coordinate) is DriveSetting other)
                    return RefuseDrive(file, before, text, $"{other.Text} drives {drive.Coordinate.ShortName} already, and a coordinate has one drive.");
                drives.Add(drive);
            }

            var doubts = new Report([.. drives.Select(drive => drive.Doubt(loaded.Scene, dt)).OfType<Diagnostic>()]);
            Tell(file, doubts);
            before = before.Concat(doubts);
            int told = world.Findings.Diagnostics.Count;
            drives.ForEach(drive => drive.Apply());
            var lost = new Report([.. world.Findings.Diagnostics.Skip(told)]);
            Tell(file, lost);
            before = before.Concat(lost);
            var steps = (int)count;
            if (Output is not null && TrajectorySize.Fault(steps, world.Bodies.Count, mechanism!.Coordinates.Count) is string excess)
                return SceneOutcome.Refused(before, $"--output {Output}: {excess} Give fewer seconds or a longer --step.");
            foreach (string path in new[] { Output, RecordTo }.OfType<string>())
            {
                Report target = TargetFile.Check(path);
                if (target.HasErrors)
                    return Fail(file, before, target);
            }

            return Move(file, loaded.Scene, world, mechanism, steps, dt, before, plan, drives);
        }

        private SceneOutcome Move(string file, ValidScene scene, World world, Mechanism? mechanism, int steps, double dt, Report before, RunRecord? plan, List<DriveSetting> drives)
        {
            var summary = new RunSummary(world, scene, Kind, steps, dt, drives);
            Recording? recording = Output is null ? null : new Recording(world, mechanism!, Kind, dt);
            StateHashes? hashes = plan is null ? null : new StateHashes(world, plan, isReplay: ReplayOf is not null);
            hashes?.Note();
            var progress = new Progress(steps);
            RunResult run = world.Run(
                steps * dt,
                step: dt,
                until: _ =>
                {
                    summary.Note();
                    recording?.Note();
                    hashes?.Note();
                    return false;
                },
                progress: progress);
            progress.End();
            Tell(file, run.Findings);
            if (!IsJson)
                summary.Write(Console.Out);
            Report found = before.Concat(run.Findings);
            Report saved = recording is null ? Report.Empty : TrajectoryFile.Save(recording.Trajectory, Output!);
            if (RecordTo is not null)
                saved = saved.Concat(RecordFile.Save(hashes!.Made, RecordTo));
            if (ReplayOf is not null)
                saved = saved.Concat(hashes!.Findings(ReplayOf));
            if (saved.HasErrors)
                return Fail(file, found, saved, summary);
            if (ReplayOf is not null && !IsJson)
                Console.Out.WriteLine(Printable.Text($"the same as {ReplayOf}"));
            return world.Stops == 0
                ? new SceneOutcome(0, found, Fields: summary.WriteJson)
                : new SceneOutcome(1, found, "the solver could not follow", summary.WriteJson);
        }

        // Of a replay the recording is at fault, not what was typed.
        private SceneOutcome RefuseDrive(string file, Report before, string text, string fault) =>
            ReplayOf is null
                ? SceneOutcome.Refused(before, $"--drive {text}: {fault}")
                : Fail(file, before, RecordFile.Unreadable(ReplayOf, $"its drive {text} is refused, {fault.TrimEnd('.')}").Report);

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
