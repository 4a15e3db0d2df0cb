using System;
using System.CommandLine;
using System.Linq;
using Kinefab.Cli.Motion;
using Kinefab.Cli.Simulation;
using Kinefab.Diagnostics;
using Kinefab.Kinematics;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab sweep FILES --joint ID --from A --to B --steps N [-o traj.json|csv] [--into-animation] [--json] [--junit FILE].</summary>
internal static class SweepCommand
{
    internal static Command Create()
    {
        var scenes = new SceneArguments();
        var joint = new Option<string>("--joint") { Description = "ID[.COORDINATE]: what the source calls the joint, or id or name of the object with it, with [COMPONENT] behind it where one object carries several.", Required = true };
        Option<double?> from = TypedOptions.Finite("--from", "First value, degrees or metres; default: the low end of the range, or 0 for a whole turn.");
        Option<double?> to = TypedOptions.Finite("--to", $"Last value; default: the high end of the range. Values up to {MechanismCoordinate.FarthestDegrees} deg or {MechanismCoordinate.FarthestMetres} m either way.");
        Option<int> steps = TypedOptions.Count("--steps", "Number of steps.", most: TypedOptions.MostSteps, standard: 72);
        Option<string?> output = TypedOptions.Trajectory();
        var animation = new Option<bool>("--into-animation") { Description = "Write the sweep into the scene as an animation clip." };
        var command = new Command("sweep", "Take a joint through its range; say how far it goes and where it stops.") { joint, from, to, steps, output, animation };
        scenes.AddTo(command);
        command.SetAction(parsed =>
        {
            SceneBatch batch = scenes.Of(parsed);
            string? target = parsed.GetValue(output);
            if ((batch.FaultOfSingle("--output", target) ?? batch.FaultOfTarget("--output", target) ?? batch.FaultOfSame(("--output", target))) is string fault)
                return WrongUsage.Refuse(fault);
            var run = new Run(parsed.GetRequiredValue(joint), parsed.GetValue(from), parsed.GetValue(to), parsed.GetValue(steps), target, parsed.GetValue(animation), batch.IsJson);
            return batch.Run(run.Of);
        });
        return command;
    }

    private sealed record Run(string Joint, double? From, double? To, int Steps, string? Output, bool IntoAnimation, bool IsJson)
    {
        internal SceneOutcome Of(string file)
        {
            if (IntoAnimation && file == LoadedScene.StandardInput)
                return SceneOutcome.Refused(Report.Empty, "--into-animation needs a file: standard input cannot be written into.");
            LoadedScene loaded = LoadedScene.Load(file, strict: false);
            Tell(file, loaded.Report);
            if (loaded.Scene is null)
                return new SceneOutcome(loaded.ExitCode, loaded.Report);
            Mechanism mechanism = Mechanism.Create(loaded.Scene);
            if (!mechanism.TryFindCoordinate(Joint, out int coordinate, out string fault))
                return SceneOutcome.Refused(loaded.Report, $"--joint {Joint}: {fault}");

            MechanismCoordinate driven = mechanism.Coordinates[coordinate];
            if (CoordinateText.RangeFault(driven, Math.Max(Math.Abs(From ?? 0), Math.Abs(To ?? 0)), driven.Unit) is string range)
                return SceneOutcome.Refused(loaded.Report, $"--from and --to {range} for {Joint}.");

            if (TrajectorySize.Fault(Steps, mechanism.Bodies.Count, mechanism.Coordinates.Count) is string excess)
                return SceneOutcome.Refused(loaded.Report, $"--steps {Steps}: {excess} Give fewer steps.");

            Report target = Targets(Output, IntoAnimation ? file : null);
            if (target.HasErrors)
            {
                Tell(file, target);
                return new SceneOutcome(1, loaded.Report.Concat(target));
            }

            return Move(file, mechanism, coordinate, loaded.Report);
        }

        private SceneOutcome Move(string file, Mechanism mechanism, int coordinate, Report before)
        {
            var sweep = new Sweep(new PositionSolver(mechanism));
            (RangeLimit low, RangeLimit high) = sweep.Range(mechanism.NewState(), coordinate);
            (double first, double last) = WholeRange(low, high);
            var progress = new Progress(Steps);
            SweepResult result = sweep.Run(mechanism.NewState(), coordinate, From ?? first, To ?? last, Steps, progress);
            progress.End();
            if (!IsJson)
                SweepText.Write(mechanism, result, low, high, Console.Out);
            Report written = Output is null ? Report.Empty : TrajectoryFile.Save(SweepTrajectory.Of(mechanism, result), Output);
            if (IntoAnimation)
                written = written.Concat(SweepAnimation.Write(file, mechanism, result, "sweep " + Joint));
            Tell(file, written);
            string? fault = result.Stop is not null || result.Jumps.Count > 0 ? result.ToString() : null;
            return new SceneOutcome(!written.HasErrors && fault is null ? 0 : 1, before.Concat(written), fault, json => SweepJson.Write(mechanism, result, low, high, json));
        }

        private void Tell(string file, Report report)
        {
            if (!IsJson)
                ReportWriter.WriteLines(file, report, Console.Error);
        }
    }

    private static Report Targets(params string?[] paths) =>
        paths.Where(p => p is not null).Aggregate(Report.Empty, (report, path) => report.Concat(TargetFile.Check(path!)));

    // A whole turn where nothing ends it; at dead centres a little less than all, since nothing drives through them.
    private static (double First, double Last) WholeRange(RangeLimit low, RangeLimit high)
    {
        const double margin = 1e-6;
        double first = low.End == RangeEnd.Open && high.End == RangeEnd.Open ? 0 : low.Value;
        double inset = margin * (high.Value - first);
        return (first + (low.End is RangeEnd.Open or RangeEnd.Limit ? 0 : inset), high.Value - (high.End is RangeEnd.Open or RangeEnd.Limit ? 0 : inset));
    }
}
