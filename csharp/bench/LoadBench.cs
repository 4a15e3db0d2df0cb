using System;
using System.Diagnostics;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Security.Cryptography;
using System.Text.Json;
using Kinefab.Document;
using Kinefab.Validation;

namespace Kinefab.Bench;

/// <summary>Load and validate beside a bare Utf8JsonReader token loop over the same bytes, run by turns in one process.</summary>
internal static class LoadBench
{
    private const int GameObjects = 100_000;
    private const int Runs = 9;

    internal static void Run()
    {
        byte[] text = GeneratedScene.Write(GameObjects, out byte[] buffer);
        DirectoryInfo folder = Directory.CreateTempSubdirectory("kinefab-bench");
        try
        {
            File.WriteAllBytes(Path.Combine(folder.FullName, "scene.kinefab"), text);
            File.WriteAllBytes(Path.Combine(folder.FullName, "scene.bin"), buffer);
            Compare(text, buffer, Path.Combine(folder.FullName, "scene.kinefab"));
        }
        finally
        {
            folder.Delete(recursive: true);
        }
    }

    private static void Compare(byte[] text, byte[] buffer, string path)
    {
        double[][] seconds = ByTurns(
            () => Tokens(text),
            () => Validate(SceneFile.Parse(text, _ => buffer)),
            () => Validate(SceneFile.Load(path)),
            () => SHA256.HashData(text));
        double megabytes = text.Length / 1e6;
        double[] rates = seconds.Select(runs => megabytes / Median(runs)).ToArray();
        Print($"scene: {megabytes:F1} MB, {GameObjects} GameObjects; medians of {Runs} runs by turns");
        Print($"Utf8JsonReader token loop:    {rates[0]:F0} MB/s");
        Print($"load + validate, from memory: {rates[1]:F0} MB/s, ratio {rates[1] / rates[0]:F2}");
        Print($"load + validate, from a file: {rates[2]:F0} MB/s, ratio {rates[2] / rates[0]:F2}");
        Print($"SHA-256, as for each buffer:  {rates[3]:F0} MB/s");
    }

    /// <summary>Each in its turn, so that a slow moment of the machine hits all; the first two rounds only warm up.</summary>
    private static double[][] ByTurns(params Action[] actions)
    {
        double[][] seconds = actions.Select(_ => new double[Runs]).ToArray();
        for (int run = -2; run < Runs; run++)
        {
            for (int i = 0; i < actions.Length; i++)
            {
                double time = Seconds(actions[i]);
                if (run >= 0)
                    seconds[i][run] = time;
            }
        }

        return seconds;
    }

    private static void Tokens(byte[] text)
    {
        var reader = new Utf8JsonReader(text);
        while (reader.Read())
        {
        }
    }

    private static void Validate(SceneReading reading)
    {
        SceneValidation validation = SceneValidator.Validate(reading.Document!);
        if (validation.Report.Diagnostics.Count > 0)
            throw new InvalidOperationException(validation.Report.Diagnostics[0].ToString());
    }

    private static double Seconds(Action action)
    {
        GC.Collect();
        GC.WaitForPendingFinalizers();
        long start = Stopwatch.GetTimestamp();
        action();
        return Stopwatch.GetElapsedTime(start).TotalSeconds;
    }

    private static double Median(double[] values) => values.Order().ElementAt(values.Length / 2);

    private static void Print(FormattableString line) => Console.Out.WriteLine(line.ToString(CultureInfo.InvariantCulture));
}
