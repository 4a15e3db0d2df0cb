using System;
using System.CommandLine;
using Kinefab.Diagnostics;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab validate FILE [--json] [--strict].</summary>
internal static class ValidateCommand
{
    internal static Command Create()
    {
        Argument<string> file = SceneArguments.File();
        Option<bool> json = SceneArguments.Json();
        Option<bool> strict = SceneArguments.Strict();
        var command = new Command("validate", "Hold a scene and its buffers to every rule.") { file, json, strict };
        command.SetAction(parsed => Run(parsed.GetRequiredValue(file), parsed.GetValue(json), parsed.GetValue(strict)));
        return command;
    }

    private static int Run(string file, bool json, bool strict)
    {
        LoadedScene loaded = LoadedScene.Load(file, strict);
        if (json)
        {
            ReportWriter.WriteJson(target => ReportWriter.WriteFields(target, file, loaded.Report));
        }
        else
        {
            ReportWriter.WriteLines(file, loaded.Report, Console.Error);
            int errors = loaded.Report.Count(Severity.Error);
            int warnings = loaded.Report.Count(Severity.Warning);
            Console.Out.WriteLine($"{file}: {(errors == 0 ? "valid" : "not valid")}, {Counted.Of(errors, "error", "errors")}, {Counted.Of(warnings, "warning", "warnings")}");
        }

        return loaded.ExitCode;
    }
}
