using System;
using System.Text.Json;
using Kinefab.Diagnostics;

namespace Kinefab.Cli;

/// <summary>What a command came to on one file.</summary>
/// <param name="ExitCode">0 ok, 1 errors found, 2 wrong usage.</param>
/// <param name="Report">What was found.</param>
/// <param name="Fault">What is wrong beside the findings, for people; null: nothing.</param>
/// <param name="Fields">Writes the command's own fields of the file's JSON object; null: there are none.</param>
internal sealed record SceneOutcome(int ExitCode, Report Report, string? Fault = null, Action<Utf8JsonWriter>? Fields = null)
{
    /// <summary>A call that cannot be done with this file.</summary>
    internal static SceneOutcome Refused(Report report, string fault) => new(Commands.WrongUsage.ExitCode, report, fault);
}
