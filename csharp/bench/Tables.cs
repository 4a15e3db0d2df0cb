using System;
using System.Globalization;
using System.IO;
using System.Linq;
using BenchmarkDotNet.Columns;
using BenchmarkDotNet.Configs;
using BenchmarkDotNet.Exporters;
using BenchmarkDotNet.Jobs;
using BenchmarkDotNet.Loggers;
using BenchmarkDotNet.Mathematics;
using BenchmarkDotNet.Reports;
using BenchmarkDotNet.Running;
using BenchmarkDotNet.Toolchains.InProcess.Emit;

namespace Kinefab.Bench;

/// <summary>Runs the benchmarks, each as a table in Markdown.</summary>
internal static class Tables
{
    /// <summary>A dash under Allocated is no byte.</summary>
    internal static string Drive()
    {
        Summary summary = Run<DriveBenchmark>(Job.ShortRun);
        double ratio = Mean(summary, "chain, 1000 bars") / Mean(summary, "chain, 10 bars");
        string exponent = (Math.Log(ratio) / Math.Log(100)).ToString("F2", CultureInfo.InvariantCulture);
        return Table(summary) + $"\nGrowth of a chain's time from 10 to 1000 bars: exponent {exponent}.\n";
    }

    /// <summary>With the growth of each kind's time from the smaller scene to the larger one.</summary>
    internal static string Mobility()
    {
        Summary summary = Run<MobilityBenchmark>(Job.Dry.WithWarmupCount(5).WithIterationCount(5));
        string exponents = string.Join(", ", MobilityScenes.Kinds.Keys.Select(kind =>
        {
            double[] least = summary.Reports.Where(r => (string)r.BenchmarkCase.Parameters["Scene"] == kind).Select(r => r.ResultStatistics!.Min).Order().ToArray();
            return string.Create(CultureInfo.InvariantCulture, $"{kind} {Math.Log(least[1] / least[0]) / Math.Log(MobilityScenes.Growth):F2}");
        }));
        return Table(summary) + $"\nGrowth of the least time with the number of joints, exponents: {exponents}.\n";
    }

    internal static string Load()
    {
        // One call takes a third of a second: enough for a measurement, too long for many.
        Summary summary = Run<LoadBenchmark>(Job.Dry.WithWarmupCount(10).WithIterationCount(15));
        double megabytes = LoadBenchmark.Length / 1e6;
        (long allocated, long kept) = LoadBenchmark.MeasureMemory();

        // The least time is what the work takes; the median has the runtime's compiler and collector in it, and other programs.
        return Table(summary)
            + string.Create(CultureInfo.InvariantCulture, $"\n{megabytes:F1} MB, and how fast against the token loop, in the least time: {Rates(result => result.Min)}.\n")
            + $"At the median: {Rates(result => result.Median)}.\n"
            + string.Create(CultureInfo.InvariantCulture, $"Allocated from memory: {allocated / 1e6:F1} MB, {(double)allocated / kept:F2} of the {kept / 1e6:F1} MB that the document's model holds.\n");

        string Rates(Func<Statistics, double> time) => string.Join(", ", summary.Reports.Select(r => string.Create(
            CultureInfo.InvariantCulture,
            $"{r.BenchmarkCase.Descriptor.WorkloadMethodDisplayInfo.Trim('\'')} {megabytes / (time(r.ResultStatistics!) / 1e9):F0} MB/s ({time(summary.Reports[0].ResultStatistics!) / time(r.ResultStatistics!):F2})")));
    }

    /// <summary>Drift and energy beside the time, which takes a harness of its own; it prints its table.</summary>
    internal static string Solver() => Written(() =>
    {
        SolverBenchmark.Run();
        ChainBenchmark.Run();
    });

    internal static string Start() => Written(StartBenchmark.Run);

    internal static string Articulation() => Written(ArticulationBenchmark.Run);

    internal static string Hub() => Written(HubBenchmark.Run);

    internal static string Package() => Written(PackageBenchmark.Run);

    internal static string Threads() => Written(ThreadBenchmark.Run);

    internal static string Rows() => Written(RowBenchmark.Run);

    internal static string Peers() => Written(PeerBenchmark.Run);

    private static string Written(Action run)
    {
        TextWriter console = Console.Out;
        using var text = new StringWriter(CultureInfo.InvariantCulture) { NewLine = "\n" };
        Console.SetOut(text);
        try
        {
            run();
        }
        finally
        {
            Console.SetOut(console);
        }

        return text.ToString();
    }

    // In this process: a benchmark of its own process would be built where it runs, which takes longer than to run it.
    private static Summary Run<T>(Job job)
    {
        ManualConfig config = ManualConfig.CreateEmpty()
            .AddJob(job.WithToolchain(InProcessEmitToolchain.Instance))
            .AddColumnProvider(DefaultColumnProviders.Descriptor, DefaultColumnProviders.Params, DefaultColumnProviders.Statistics, DefaultColumnProviders.Metrics)
            .AddColumn(StatisticColumn.Min)
            .WithSummaryStyle(SummaryStyle.Default.WithMaxParameterColumnWidth(40))
            .AddLogger(NullLogger.Instance)
            .WithArtifactsPath(Path.Combine(Path.GetTempPath(), "kinefab-bench"));
        Summary summary = BenchmarkRunner.Run<T>(config);
        return summary.HasCriticalValidationErrors || summary.Reports.Any(r => !r.Success)
            ? throw new InvalidOperationException("A benchmark did not run.")
            : summary;
    }

    private static double Mean(Summary summary, string scene) =>
        summary.Reports.Single(r => (string)r.BenchmarkCase.Parameters["Scene"] == scene).ResultStatistics!.Mean;

    private static string Table(Summary summary)
    {
        var log = new AccumulationLogger();
        MarkdownExporter.GitHub.ExportToLog(summary, log);
        string text = log.GetLog().Replace("&#39;", "", StringComparison.Ordinal).Replace("**", "", StringComparison.Ordinal);
        return string.Join('\n', text.Split('\n').Select(line => line.TrimEnd())).Trim('\n') + "\n";
    }
}
