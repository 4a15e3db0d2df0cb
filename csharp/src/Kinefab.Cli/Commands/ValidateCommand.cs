using System;
using System.CommandLine;
using Kinefab.Diagnostics;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab validate FILES [--json] [--junit FILE] [--strict].</summary>
internal static class ValidateCommand
{
    internal static Command Create()
    {
        var scenes = new SceneArguments();
        Option<bool> strict = SceneArguments.Strict();
        var command = new Command("validate", "Hold a scene and its buffers to every rule.") { strict };
        scenes.AddTo(command);
        command.SetAction(parsed =>
        {
            SceneBatch batch = scenes.Of(parsed);
            return batch.Run(file => Run(file, batch.IsJson, parsed.GetValue(strict)));
        });
        return command;
    }

    private static SceneOutcome Run(string file, bool json, bool strict)
    {
        LoadedScene loaded = LoadedScene.Load(file, strict);
        if (!json)
        {
            ReportWriter.WriteLines(file, loaded.Report, Console.Error);
            int errors = loaded.Report.Count(Severity.Error);
            int warnings = loaded.Report.Count(Severity.Warning);
            Console.Out.WriteLine(Printable.Text($"{file}: {(errors == 0 ? "valid" : "not valid")}, {Counted.Of(errors, "error", "errors")}, {Counted.Of(warnings, "warning", "warnings")}"));
        }

        return new SceneOutcome(loaded.ExitCode, loaded.Report);
    }
}
