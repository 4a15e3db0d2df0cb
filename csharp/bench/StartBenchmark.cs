using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Runtime.CompilerServices;

namespace Kinefab.Bench;

/// <summary>
/// `dotnet kinefab validate` of the lever as a whole process, start and end included: compiled while it runs, as the
/// tool's package has it (ReadyToRun), and as machine code alone (NativeAOT). In turns, so that each meets the same machine.
/// </summary>
internal static class StartBenchmark
{
    private const int Runs = 30;

    internal static void Run()
    {
        DirectoryInfo folder = Directory.CreateTempSubdirectory("kinefab-bench");
        try
        {
            (string Name, string Program)[] programs =
            [
                ("compiled while it runs", Publish(folder, "jit")),
                ("ReadyToRun, as packed", Publish(folder, "r2r", "-r", System.Runtime.InteropServices.RuntimeInformation.RuntimeIdentifier, "--self-contained", "false", "-p:PublishReadyToRun=true")),
                ("NativeAOT", Publish(folder, "aot", "-p:Native=true")),
            ];
            var times = programs.ToDictionary(p => p.Name, _ => new List<double>());
            for (int i = 0; i <= Runs; i++)
                foreach ((string name, string program) in programs)
                    if (Time(program) is var time && i > 0)
                        times[name].Add(time);
            Console.WriteLine("| validate of the lever, a process | ms, least | ms, median | of the first, least | spread |");
            Console.WriteLine("|---|---|---|---|---|");
            double first = times[programs[0].Name].Min();
            foreach ((string name, List<double> of) in times)
                Console.WriteLine(string.Create(CultureInfo.InvariantCulture, $"| {name} | {of.Min():F0} | {of.Order().ElementAt(Runs / 2):F0} | {of.Min() / first:F2} | {(of.Max() / of.Min() - 1) * 100:F0} % |"));
            Console.WriteLine($"\n{Runs} runs by turns, wall time; spread: the slowest over the fastest. {Machine.Description}.");
        }
        finally
        {
            folder.Delete(recursive: true);
        }
    }

    private static string Publish(DirectoryInfo folder, string name, params string[] arguments)
    {
        string output = Path.Combine(folder.FullName, name);
        using Process process = Process.Start(new ProcessStartInfo(
            "dotnet", ["publish", Checkout("csharp/src/Kinefab.Cli"), "-c", "Release", "-v", "quiet", "--nologo", "-o", output, .. arguments]))!;
        process.WaitForExit();
        return process.ExitCode == 0 ? Path.Combine(output, "dotnet-kinefab") : throw new InvalidOperationException($"The tool was not published as {name}.");
    }

    private static double Time(string program)
    {
        long start = Stopwatch.GetTimestamp();
        using Process process = Process.Start(new ProcessStartInfo(program, ["validate", Checkout("fixtures/lever/lever.kinefab")]) { RedirectStandardOutput = true })!;
        process.StandardOutput.ReadToEnd();
        process.WaitForExit();
        return Stopwatch.GetElapsedTime(start).TotalMilliseconds;
    }

    private static string Checkout(string path, [CallerFilePath] string here = "") => Path.GetFullPath(Path.Combine(Path.GetDirectoryName(here)!, "..", "..", path));
}
