using System;
using System.Globalization;
using System.IO;
using System.Linq;
using Kinefab.Kinematics;
using static Kinefab.Cli.Motion.CoordinateText;

namespace Kinefab.Cli.Motion;

/// <summary>A sweep as people read it.</summary>
internal static class SweepText
{
    internal static void Write(Mechanism mechanism, SweepResult result, RangeLimit low, RangeLimit high, TextWriter target)
    {
        string unit = mechanism.Coordinates[result.Coordinate].IsAngle ? "deg" : "m";
        Line(target, $"swept      {Number(result.Values[0])} to {Number(result.Values[^1])} {unit} in {Counted.Of(result.States.Count - 1, "step", "steps")}");
        Line(target, $"range      {End(mechanism, low)} to {End(mechanism, high)} {unit}");
        for (int i = 0; i < result.Branches.Count; i++)
            Line(target, $"branch     {(i > 0 ? "not taken" : result.Branches.Count == 1 ? "taken, the only one found" : $"taken, the straightest of {result.Branches.Count}")}: {Rates(mechanism, result.Branches[i])}");
        if (result.Stop is RangeLimit stop)
            Line(target, $"stopped    {End(mechanism, stop)} {unit}");
        foreach (double jump in result.Jumps)
            Line(target, $"jumped     to another branch at {Number(jump)} {unit}");
        Line(target, $"worst gap  {result.WorstErrorMetres.ToString("0.0e+0", CultureInfo.InvariantCulture)} m, {result.WorstErrorDegrees.ToString("0.0e+0", CultureInfo.InvariantCulture)} deg");
        for (int i = 0; i < mechanism.Coordinates.Count; i++)
        {
            int index = i;
            MechanismCoordinate coordinate = mechanism.Coordinates[i];
            double least = result.States.Min(s => s.Coordinate(index));
            double most = result.States.Max(s => s.Coordinate(index));
            Line(target, $"           {Name(mechanism, i)}{InWords(coordinate)} {Number(least)} to {Number(most)} {(coordinate.IsAngle ? "deg" : "m")}");
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

    // What the source's user calls it, where that is no part of the name.
    private static string InWords(MechanismCoordinate coordinate) =>
        coordinate.Name.StartsWith(coordinate.ShortName, StringComparison.Ordinal) ? "" : $" \"{coordinate.ShortName}\"";

    private static void Line(TextWriter target, string text) => target.WriteLine(Printable.Text(text));
}
