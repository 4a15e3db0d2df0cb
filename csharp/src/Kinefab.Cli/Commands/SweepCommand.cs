using System;
using System.CommandLine;
using System.Globalization;
using System.IO;
using System.Linq;
using Kinefab.Cli.Motion;
using Kinefab.Cli.Simulation;
using Kinefab.Diagnostics;
using Kinefab.Kinematics;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab sweep FILE --joint ID --from A --to B --steps N [-o traj.json|csv] [--into-animation].</summary>
internal static class SweepCommand
{
    // The solver walks all of the way, in steps of a fraction of a radian or of the mechanism's length.
    private const double FarthestDegrees = 360_000;
    private const double FarthestMetres = 1000;

    internal static Command Create()
    {
        Argument<string> file = SceneArguments.File();
        var joint = new Option<string>("--joint") { Description = "ID[.COORDINATE]: id or name of the object with the joint, with [COMPONENT] behind it where one object carries several.", Required = true };
        Option<double?> from = TypedOptions.Finite("--from", "First value, degrees or metres; default: the low end of the range, or 0 for a whole turn.");
        Option<double?> to = TypedOptions.Finite("--to", $"Last value; default: the high end of the range. Values up to {FarthestDegrees} deg or {FarthestMetres} m either way.");
        Option<int> steps = TypedOptions.Count("--steps", "Number of steps.", most: TypedOptions.MostSteps, standard: 72);
        Option<string?> output = TypedOptions.Trajectory();
        var animation = new Option<bool>("--into-animation") { Description = "Write the sweep into the scene as an animation clip." };
        var command = new Command("sweep", "Take a joint through its range; say how far it goes and where it stops.") { file, joint, from, to, steps, output, animation };
        command.SetAction(parsed => Run(
            parsed.GetRequiredValue(file),
            parsed.GetRequiredValue(joint),
            parsed.GetValue(from),
            parsed.GetValue(to),
            parsed.GetValue(steps),
            parsed.GetValue(output),
            parsed.GetValue(animation)));
        return command;
    }

    private static int Run(string file, string joint, double? from, double? to, int steps, string? output, bool intoAnimation)
    {
        LoadedScene loaded = LoadedScene.Load(file, strict: false);
        ReportWriter.WriteLines(file, loaded.Report, Console.Error);
        if (loaded.Scene is null)
            return loaded.ExitCode;
        Mechanism mechanism = Mechanism.Create(loaded.Scene);
        if (!mechanism.TryFindCoordinate(joint, out int coordinate, out string fault))
            return WrongUsage.Refuse($"--joint {joint}: {fault}");

        bool isAngle = mechanism.Coordinates[coordinate].IsAngle;
        double farthest = isAngle ? FarthestDegrees : FarthestMetres;
        if (Math.Max(Math.Abs(from ?? 0), Math.Abs(to ?? 0)) > farthest)
            return WrongUsage.Refuse($"--from and --to must lie between -{Number(farthest)} and {Number(farthest)} {(isAngle ? "deg" : "m")} for {joint}.");

        if (TrajectorySize.Fault(steps, mechanism.Bodies.Count, mechanism.Coordinates.Count) is string excess)
            return WrongUsage.Refuse($"--steps {steps}: {excess} Give fewer steps.");

        Report target = Targets(output, intoAnimation ? file : null);
        if (target.HasErrors)
        {
            ReportWriter.WriteLines(file, target, Console.Error);
            return 1;
        }

        var sweep = new Sweep(new PositionSolver(mechanism));
        (RangeLimit low, RangeLimit high) = sweep.Range(mechanism.NewState(), coordinate);
        (double first, double last) = WholeRange(low, high);
        var progress = new Progress(steps);
        SweepResult result = sweep.Run(mechanism.NewState(), coordinate, from ?? first, to ?? last, steps, progress);
        progress.End();
        Write(mechanism, result, low, high, Console.Out);
        Report written = output is null ? Report.Empty : TrajectoryFile.Save(SweepTrajectory.Of(mechanism, result), output);
        if (intoAnimation)
            written = written.Concat(SweepAnimation.Write(file, mechanism, result, "sweep " + joint));
        ReportWriter.WriteLines(file, written, Console.Error);
        return !written.HasErrors && result.Stop is null && result.Jumps.Count == 0 ? 0 : 1;
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

    private static void Write(Mechanism mechanism, SweepResult result, RangeLimit low, RangeLimit high, TextWriter target)
    {
        string unit = mechanism.Coordinates[result.Coordinate].IsAngle ? "deg" : "m";
        target.WriteLine($"swept      {Number(result.Values[0])} to {Number(result.Values[^1])} {unit} in {Counted.Of(result.States.Count - 1, "step", "steps")}");
        target.WriteLine($"range      {End(mechanism, low)} to {End(mechanism, high)} {unit}");
        for (int i = 0; i < result.Branches.Count; i++)
            target.WriteLine($"branch     {(i > 0 ? "not taken" : result.Branches.Count == 1 ? "taken, the only one found" : $"taken, the straightest of {result.Branches.Count}")}: {Rates(mechanism, result.Branches[i])}");
        if (result.Stop is RangeLimit stop)
            target.WriteLine($"stopped    {End(mechanism, stop)} {unit}");
        foreach (double jump in result.Jumps)
            target.WriteLine($"jumped     to another branch at {Number(jump)} {unit}");
        target.WriteLine($"worst gap  {result.WorstErrorMetres.ToString("E1", CultureInfo.InvariantCulture)} m, {result.WorstErrorDegrees.ToString("E1", CultureInfo.InvariantCulture)} deg");
        for (int i = 0; i < mechanism.Coordinates.Count; i++)
        {
            int index = i;
            MechanismCoordinate coordinate = mechanism.Coordinates[i];
            double least = result.States.Min(s => s.Coordinate(index));
            double most = result.States.Max(s => s.Coordinate(index));
            target.WriteLine($"           {Name(mechanism, i)} {Number(least)} to {Number(most)} {(coordinate.IsAngle ? "deg" : "m")}");
        }
    }

    // By degree or metre of the driven joint.
    private static string Rates(Mechanism mechanism, MotionBranch branch) => string.Join(", ", Enumerable.Range(0, branch.Rates.Count)
        .Select(i => $"{Name(mechanism, i)} {branch.Rates[i].ToString("+0.###;-0.###;0", CultureInfo.InvariantCulture)}"));

    private static string End(Mechanism mechanism, RangeLimit limit) => limit.End switch
    {
        RangeEnd.Open => $"{Number(limit.Value)} (open)",
        RangeEnd.Limit when limit.Limit is ReachedLimit reached => $"{Number(limit.Value)} (limit of {Name(mechanism, mechanism.FindCoordinate(reached.GameObject, reached.Component, reached.Coordinate))})",
        RangeEnd.Fold => $"{Number(limit.Value)} (dead centre)",
        RangeEnd.Bifurcation => $"{Number(limit.Value)} (branches cross)",
        _ => $"{Number(limit.Value)} (no pose found beyond)",
    };

    private static string Name(Mechanism mechanism, int coordinate) => mechanism.Coordinates[coordinate].Name;

    // As it is written, without the sign that the format gives a negative number that comes to 0.
    private static string Number(double value) => (Math.Round(value, 6) + 0.0).ToString("0.######", CultureInfo.InvariantCulture);
}
