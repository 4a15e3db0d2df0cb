using System;
using System.IO;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Validation;

namespace Kinefab.Cli;

/// <summary>A scene as a command gets it: read and validated, with everything found on the way.</summary>
internal sealed class LoadedScene
{
    /// <summary>The name that stands for standard input.</summary>
    internal const string StandardInput = "-";

    private LoadedScene(ValidScene? scene, Report report)
    {
        Scene = scene;
        Report = report;
    }

    /// <summary>Null when the report has errors.</summary>
    internal ValidScene? Scene { get; }

    internal Report Report { get; }

    internal int ExitCode => Report.HasErrors ? 1 : 0;

    internal static LoadedScene Load(string path, bool strict)
    {
        var options = new SceneReadOptions { Strict = strict };
        SceneReading reading = path == StandardInput
            ? SceneFile.Load(Console.OpenStandardInput(), Directory.GetCurrentDirectory(), options)
            : SceneFile.Load(path, options);
        if (reading.Document is null)
            return new LoadedScene(null, reading.Report);
        SceneValidation validation = SceneValidator.Validate(reading.Document);
        return new LoadedScene(validation.Scene, reading.Report.Concat(validation.Report));
    }
}
