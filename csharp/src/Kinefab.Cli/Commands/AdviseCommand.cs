using System;
using System.CommandLine;
using Kinefab.Advice;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab advise FILE [--json] [--seconds S] [--trials N].</summary>
internal static class AdviseCommand
{
    private const int MostTrials = 10_000;

    internal static Command Create()
    {
        Argument<string> file = SceneArguments.File();
        Option<bool> json = SceneArguments.Json();
        Option<double?> seconds = TypedOptions.Positive("--seconds", "How long to simulate; default: 2, less in scenes of many joints.");
        Option<int> trials = TypedOptions.Count("--trials", "Changes to try at most.", MostTrials, new AdviceOptions().MaxTrials);
        var command = new Command("advise", "Say what Unity's solver will make trouble of, and what was tried against it and helped.") { file, json, seconds, trials };
        command.SetAction(parsed => Run(parsed.GetRequiredValue(file), parsed.GetValue(json), parsed.GetValue(seconds), parsed.GetValue(trials)));
        return command;
    }

    private static int Run(string file, bool json, double? seconds, int trials)
    {
        LoadedScene loaded = LoadedScene.Load(file, strict: false);
        AdviceReport? advice = loaded.Scene is null
            ? null
            : StabilityAdvice.Of(loaded.Scene, new AdviceOptions { Seconds = seconds, MaxTrials = trials, Progress = Tell });
        if (json)
        {
            ReportWriter.WriteJson(target =>
            {
                ReportWriter.WriteFields(target, file, advice is null ? loaded.Report : loaded.Report.Concat(advice.Report));
                if (advice is not null)
                    AdviceJson.Write(advice, target);
            });
        }
        else
        {
            ReportWriter.WriteLines(file, loaded.Report, Console.Error);
            if (advice is not null)
                AdviceText.Write(file, advice, Console.Out);
        }

        return loaded.ExitCode;
    }

    private static void Tell(string what)
    {
        if (!Console.IsErrorRedirected)
            Console.Error.WriteLine("running " + what);
    }
}
