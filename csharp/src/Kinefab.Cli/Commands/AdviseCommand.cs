using System;
using System.CommandLine;
using Kinefab.Advice;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab advise FILES [--json] [--junit FILE] [--seconds S] [--trials N].</summary>
internal static class AdviseCommand
{
    private const int MostTrials = 10_000;

    internal static Command Create()
    {
        var scenes = new SceneArguments();
        Option<double?> seconds = TypedOptions.Positive("--seconds", "How long to simulate; default: 2, less in scenes of many joints.");
        Option<int> trials = TypedOptions.Count("--trials", "Changes to try at most.", MostTrials, new AdviceOptions().MaxTrials);
        var command = new Command("advise", $"Say what Unity's solver will make trouble of, and what was tried against it and helped. In what it prints, {AdviceText.Legend}") { seconds, trials };
        scenes.AddTo(command);
        command.SetAction(parsed =>
        {
            SceneBatch batch = scenes.Of(parsed);
            var options = new AdviceOptions { Seconds = parsed.GetValue(seconds), MaxTrials = parsed.GetValue(trials), Progress = new Teller() };
            return batch.Run(file => Run(file, batch.IsJson, options));
        });
        return command;
    }

    private static SceneOutcome Run(string file, bool json, AdviceOptions options)
    {
        LoadedScene loaded = LoadedScene.Load(file, strict: false);
        AdviceReport? advice = loaded.Scene is null ? null : StabilityAdvice.Of(loaded.Scene, options);
        if (!json)
        {
            ReportWriter.WriteLines(file, loaded.Report, Console.Error);
            if (advice is not null)
                AdviceText.Write(file, advice, Console.Out);
        }

        return advice is null
            ? new SceneOutcome(loaded.ExitCode, loaded.Report)
            : new SceneOutcome(loaded.ExitCode, loaded.Report.Concat(advice.Report), Fields: target => AdviceJson.Write(advice, target));
    }

    private sealed class Teller : IProgress<string>
    {
        public void Report(string value)
        {
            if (!Console.IsErrorRedirected)
                Console.Error.WriteLine("running " + value);
        }
    }
}
