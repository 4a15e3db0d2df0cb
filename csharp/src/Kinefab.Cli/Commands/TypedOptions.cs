using System;
using System.CommandLine;
using System.CommandLine.Parsing;
using System.Globalization;
using System.IO;
using Kinefab.Dynamics;

namespace Kinefab.Cli.Commands;

/// <summary>Options whose values are held to a rule; a wrong value is named in the user's words.</summary>
internal static class TypedOptions
{
    /// <summary>Steps of any run: minutes of work for a mechanism.</summary>
    internal const int MostSteps = 1_000_000;

    /// <summary>Seconds. A body's place is known to 1e-16 of its distance: over 1e-15 s that is a metre a second, which no joint put there.</summary>
    internal const double ShortestStep = 1e-9;

    internal static Option<double?> Positive(string name, string description) =>
        Number(name, description, value => value > 0, "a positive number");

    internal static Option<double?> Finite(string name, string description) => Number(name, description, _ => true, "a finite number");

    internal static Option<int> Count(string name, string description, int most, int standard) => new(name)
    {
        Description = description,
        DefaultValueFactory = _ => standard,
        CustomParser = result =>
        {
            if (int.TryParse(Text(result), NumberStyles.None, CultureInfo.InvariantCulture, out int value) && value >= 1 && value <= most)
                return value;
            result.AddError($"{name} must be a whole number between 1 and {most}, not '{Text(result)}'.");
            return standard;
        },
    };

    internal static Option<SolverKind> Solver()
    {
        var option = new Option<SolverKind>("--solver")
        {
            Description = "unity: as Unity moves it; exact: as it truly moves. [default: unity]",
            HelpName = "unity|exact",
            CustomParser = result =>
            {
                switch (Text(result))
                {
                    case "unity":
                        return SolverKind.Unity;
                    case "exact":
                        return SolverKind.Exact;
                    default:
                        result.AddError($"--solver must be unity or exact, not '{Text(result)}'.");
                        return SolverKind.Unity;
                }
            },
        };
        option.CompletionSources.Clear();
        option.CompletionSources.Add("unity", "exact");
        return option;
    }

    internal static Option<string?> Trajectory()
    {
        var option = new Option<string?>("--output", "-o") { Description = "Trajectory file, .json or .csv." };
        option.Validators.Add(result =>
        {
            string extension = result.Tokens.Count == 1 ? Path.GetExtension(result.Tokens[0].Value) : ".json";
            if (!extension.Equals(".json", StringComparison.OrdinalIgnoreCase) && !extension.Equals(".csv", StringComparison.OrdinalIgnoreCase))
                result.AddError($"--output must end in .json or .csv, not '{extension}'.");
        });
        return option;
    }

    /// <summary>A file's name.</summary>
    internal static Option<string?> File(string name, string description)
    {
        var option = new Option<string?>(name) { Description = description };
        option.Validators.Add(result =>
        {
            if (result.Tokens.Count == 1 && result.Tokens[0].Value.Length == 0)
                result.AddError($"{name} must name a file, not ''.");
        });
        return option;
    }

    private static Option<double?> Number(string name, string description, Func<double, bool> isAllowed, string wanted) => new(name)
    {
        Description = description,
        CustomParser = result =>
        {
            if (double.TryParse(Text(result), NumberStyles.Float, CultureInfo.InvariantCulture, out double value) && double.IsFinite(value) && isAllowed(value))
                return value;
            result.AddError($"{name} must be {wanted}, not '{Text(result)}'.");
            return null;
        },
    };

    private static string Text(ArgumentResult result) => result.Tokens.Count == 0 ? "" : result.Tokens[0].Value;
}
