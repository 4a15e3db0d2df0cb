using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Globalization;
using System.Linq;
using System.Runtime.InteropServices;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Pgs;
using Kinefab.Dynamics.Rattle;
using Kinefab.Numerics;
using Kinefab.Tests.Dynamics.Rattle;

namespace Kinefab.Bench;

/// <summary>10,000 joints in 1,000 islands, hanging chains of 10 bars, by one thread and by several: wall time, and whether the bits are the same.</summary>
internal static class ThreadBenchmark
{
    private const int Islands = 1000;
    private const int Links = 10;
    private const int Steps = 60;
    private const int Runs = 9;
    private const double Dt = 1.0 / 60;

    public static void Run()
    {
        int most = Math.Min(Environment.ProcessorCount, 4);
        Console.WriteLine($"| solver | 1 thread, us/step | {most} threads, us/step | speed | spread | bits |");
        Console.WriteLine("|---|---|---|---|---|---|");
        Row("unity", most, system => new PgsSolver(system));
        Row("exact, 1 lanes", most, system => new RattleSolver(system, 1));
        Row("exact, 4 lanes", most, system => new RattleSolver(system, 4));
        Row("exact, 8 lanes", most, system => new RattleSolver(system, 8));
        Console.WriteLine($"\n{Islands * Links} joints in {Islands} islands. Wall time, every step's least of {Runs} runs by turns: that of other programs counts where it fell into all of them; spread, of one thread and of several: the slowest run over the fastest. {Machine.Description}.");
    }

    private static void Row(string name, int most, Func<MultibodySystem, ISolver> make)
    {
        double[] best = Enumerable.Repeat(double.PositiveInfinity, 2 * Steps).ToArray();
        var totals = new List<double>();
        var ends = new HashSet<long>();
        for (int run = 0; run < 2 * Runs; run++)
        {
            MultibodySystem system = SolverScenes.HangingChains(Islands, Links);
            system.Threads = run % 2 == 0 ? 1 : most;
            ISolver solver = make(system);
            long began = Stopwatch.GetTimestamp();
            for (int i = 0; i < Steps; i++)
            {
                long before = Stopwatch.GetTimestamp();
                solver.Step(Dt);
                int at = run % 2 * Steps + i;
                best[at] = Math.Min(best[at], Stopwatch.GetElapsedTime(before).TotalMicroseconds);
            }

            totals.Add(Stopwatch.GetElapsedTime(began).TotalMicroseconds);
            ends.Add(Sum(system));
        }

        double one = best.Take(Steps).Average();
        double several = best.Skip(Steps).Average();
        Console.WriteLine(string.Create(CultureInfo.InvariantCulture, $"| {name} | {one:F0} | {several:F0} | {one / several:F2} | {Spread(totals, 0) * 100:F0} %, {Spread(totals, 1) * 100:F0} % | {(ends.Count == 1 ? "the same" : "DIFFER")} |"));
    }

    // Of every second run, the slowest over the fastest.
    private static double Spread(List<double> totals, int first)
    {
        double[] runs = totals.Where((_, run) => run % 2 == first).ToArray();
        return runs.Max() / runs.Min() - 1;
    }

    private static long Sum(MultibodySystem system)
    {
        long sum = 17;
        foreach (long bits in MemoryMarshal.Cast<Pose, long>(system.Bodies.Poses))
            sum = unchecked(sum * 1099511628211 + bits);
        return sum;
    }
}
