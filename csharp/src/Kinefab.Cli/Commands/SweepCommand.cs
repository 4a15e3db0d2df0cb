using System;
using System.CommandLine;
using System.Globalization;
using System.IO;
using System.Linq;
using Kinefab.Cli.Motion;
using Kinefab.Kinematics;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab sweep FILE --joint ID --from A --to B --steps N [-o traj.json|csv] [--into-animation].</summary>
internal static class SweepCommand
{
    private const int WrongUsage = 2;

    internal static Command Create()
    {
        Argument<string> file = SceneArguments.File();
        var joint = new Option<string>("--joint") { Description = "ID[.COORDINATE]: id or name of the object with the joint.", Required = true };
        Option<double?> from = TypedOptions.Finite("--from", "First value, degrees or metres; default: the low end of the range, or 0 for a whole turn.");
        Option<double?> to = TypedOptions.Finite("--to", "Last value; default: the high end of the range.");
        Option<int> steps = TypedOptions.Count("--steps", "Number of steps.", most: 1_000_000, standard: 72);
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
        {
            Console.Error.WriteLine($"--joint {joint}: {fault}");
            return WrongUsage;
        }

        var sweep = new Sweep(new PositionSolver(mechanism));
        (RangeLimit low, RangeLimit high) = sweep.Range(mechanism.NewState(), coordinate);
        (double first, double last) = WholeRange(low, high);
        SweepResult result = sweep.Run(mechanism.NewState(), coordinate, from ?? first, to ?? last, steps);
        Write(mechanism, result, low, high, Console.Out);
        try
        {
            if (output is not null)
                TrajectoryFile.Save(SweepTrajectory.Of(mechanism, result), output);
            if (intoAnimation)
                SweepAnimation.Write(file, mechanism, result, "sweep " + joint);
        }
        catch (Exception e) when (e is IOException or UnauthorizedAccessException or NotSupportedException)
        {
            Console.Error.WriteLine($"error TARGET_UNWRITABLE: {output ?? file} cannot be written: {e.Message}");
            return 1;
        }

        return result.Stop is null && result.Jumps.Count == 0 ? 0 : 1;
    }

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
        target.WriteLine($"swept      {Number(result.Values[0])} to {Number(result.Values[^1])} {unit} in {result.States.Count - 1} steps");
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

    private static string Number(double value) => Math.Round(value, 9).ToString("0.######", CultureInfo.InvariantCulture);
}
