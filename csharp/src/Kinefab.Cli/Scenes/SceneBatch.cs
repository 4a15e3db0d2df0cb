using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text;
using System.Text.Encodings.Web;
using System.Text.Json;
using Kinefab.Cli.Commands;
using Kinefab.Cli.Motion;
using Kinefab.Diagnostics;

namespace Kinefab.Cli;

/// <summary>The files of a call, and how it is told what came of each: as text, as JSON, and in a JUnit report beside either.</summary>
internal sealed class SceneBatch(string command, IReadOnlyList<string> files, bool isJson, string? junit)
{
    // As the file systems compare that these systems come with. Where a disk tells letter cases apart after all, too much is refused, and nothing lost.
    private static readonly StringComparer Paths = OperatingSystem.IsWindows() || OperatingSystem.IsMacOS() ? StringComparer.OrdinalIgnoreCase : StringComparer.Ordinal;

    /// <summary>Whether each file's findings and outcome are printed as JSON, so that a command prints nothing itself.</summary>
    internal bool IsJson => isJson;

    /// <summary>Why an option for one file alone cannot be given; null: it can.</summary>
    internal string? FaultOfSingle(string option, string? value)
    {
        if (value is null)
            return null;
        return files.Count > 1 ? $"{option} {value}: it takes one scene file, not {files.Count}." : null;
    }

    /// <summary>Why an option cannot write to a path; null: it can.</summary>
    internal string? FaultOfTarget(string option, string? path)
    {
        if (string.IsNullOrEmpty(path))
            return null;
        string target = Real(path);
        return files.Any(file => file is not ("" or LoadedScene.StandardInput) && Paths.Equals(Real(file), target))
            ? $"{option} {path}: it is one of the scene files, and would be lost."
            : null;
    }

    /// <summary>Why the files that options name cannot all be written, the JUnit report among them; null: they can.</summary>
    internal string? FaultOfSame(params (string Option, string? Path)[] targets)
    {
        var seen = new Dictionary<string, string>(Paths);
        foreach ((string option, string? path) in targets.Append(("--junit", junit)))
        {
            if (string.IsNullOrEmpty(path))
                continue;
            string target = Real(path);
            if (!seen.TryAdd(target, option))
                return $"{option} {path}: it is {seen[target]}'s file too, and one of the two would be lost.";
        }

        return null;
    }

    /// <summary>Does something with every file and gives the exit code: the greatest of all.</summary>
    internal int Run(Func<string, SceneOutcome> each)
    {
        if (FaultOfTarget("--junit", junit) is string fault)
            return WrongUsage.Refuse(fault);
        Report target = junit is null ? Report.Empty : TargetFile.Check(junit);
        if (target.HasErrors)
            return Fail(target);
        var outcomes = new List<(string File, SceneOutcome Outcome)>();
        if (isJson)
        {
            RunJson(each, outcomes);
        }
        else
        {
            foreach (string file in files)
                outcomes.Add((file, RunText(file, each)));
        }

        int exit = outcomes.Max(one => one.Outcome.ExitCode);
        Report written = junit is null ? Report.Empty : TargetFile.Write(junit, stream => JUnitFile.Write(stream, command, outcomes));
        return written.HasErrors ? Math.Max(exit, Fail(written)) : exit;
    }

    // What is written through a link is the file behind it.
    private static string Real(string path)
    {
        try
        {
            return Path.GetFullPath(TargetFile.Behind(path));
        }
        catch (IOException)
        {
            return Path.GetFullPath(path);
        }
    }

    private SceneOutcome RunText(string file, Func<string, SceneOutcome> each)
    {
        if (files.Count > 1 && command != "validate")
            Console.Out.WriteLine(Printable.Text(file));
        SceneOutcome outcome = each(file);
        if (outcome.ExitCode == WrongUsage.ExitCode)
            WrongUsage.Refuse(outcome.Fault!);
        return outcome;
    }

    private void RunJson(Func<string, SceneOutcome> each, List<(string File, SceneOutcome Outcome)> outcomes)
    {
        using var buffer = new MemoryStream();
        using (var json = new Utf8JsonWriter(buffer, new JsonWriterOptions { Indented = true, NewLine = "\n", Encoder = JavaScriptEncoder.UnsafeRelaxedJsonEscaping }))
        {
            if (files.Count > 1)
                json.WriteStartArray();
            foreach (string file in files)
            {
                SceneOutcome outcome = each(file);
                outcomes.Add((file, outcome));
                if (outcome.ExitCode == WrongUsage.ExitCode)
                {
                    WrongUsage.Refuse(outcome.Fault!);
                    continue;
                }

                json.WriteStartObject();
                ReportWriter.WriteFields(json, file, outcome.Report);
                outcome.Fields?.Invoke(json);
                json.WriteEndObject();
            }

            if (files.Count > 1)
                json.WriteEndArray();
        }

        if (buffer.Length > 0)
            Write(Encoding.UTF8.GetString(buffer.ToArray()));
    }

    private static void Write(string json)
    {
        if (Console.Out is Terminal terminal)
            terminal.Raw(json + Environment.NewLine);
        else
            Console.Out.WriteLine(json);
    }

    private int Fail(Report report)
    {
        ReportWriter.WriteLines(junit!, report, Console.Error);
        return 1;
    }
}
