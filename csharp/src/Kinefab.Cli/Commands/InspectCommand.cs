using System;
using System.CommandLine;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab inspect FILES [--json] [--junit FILE].</summary>
internal static class InspectCommand
{
    internal static Command Create()
    {
        var scenes = new SceneArguments();
        var command = new Command("inspect", "Say what is in a scene and what became of the source's features.");
        scenes.AddTo(command);
        command.SetAction(parsed =>
        {
            SceneBatch batch = scenes.Of(parsed);
            return batch.Run(file => Run(file, batch.IsJson));
        });
        return command;
    }

    private static SceneOutcome Run(string file, bool json)
    {
        LoadedScene loaded = LoadedScene.Load(file, strict: false);
        SceneSummary? summary = loaded.Scene is null ? null : new SceneSummary(loaded.Scene);
        if (!json)
        {
            ReportWriter.WriteLines(file, loaded.Report, Console.Error);
            if (summary is not null)
                SummaryText.Write(summary, Console.Out);
        }

        return new SceneOutcome(loaded.ExitCode, loaded.Report, Fields: summary is null ? null : target => SummaryJson.Write(summary, target));
    }
}
