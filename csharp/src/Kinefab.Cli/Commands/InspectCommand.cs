using System;
using System.CommandLine;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab inspect FILE [--json].</summary>
internal static class InspectCommand
{
    internal static Command Create()
    {
        Argument<string> file = SceneArguments.File();
        Option<bool> json = SceneArguments.Json();
        var command = new Command("inspect", "Say what is in a scene and what became of the source's features.") { file, json };
        command.SetAction(parsed => Run(parsed.GetRequiredValue(file), parsed.GetValue(json)));
        return command;
    }

    private static int Run(string file, bool json)
    {
        LoadedScene loaded = LoadedScene.Load(file, strict: false);
        SceneSummary? summary = loaded.Scene is null ? null : new SceneSummary(loaded.Scene);
        if (json)
        {
            ReportWriter.WriteJson(target =>
            {
                ReportWriter.WriteFields(target, file, loaded.Report);
                if (summary is not null)
                    SummaryJson.Write(summary, target);
            });
        }
        else
        {
            ReportWriter.WriteLines(file, loaded.Report, Console.Error);
            if (summary is not null)
                SummaryText.Write(summary, Console.Out);
        }

        return loaded.ExitCode;
    }
}
