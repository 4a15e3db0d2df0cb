using System;
using System.Diagnostics;
using System.Globalization;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Tests.Dynamics.Rattle;

namespace Kinefab.Bench;

/// <summary>How a chain's cost grows with its length.</summary>
internal static class ChainBenchmark
{
    // Short enough that the tension of the longest chain asks for no shorter steps.
    private const double Dt = 1.0 / 960;
    private const int Steps = 200;
    private const int Runs = 5;

    public static void Run()
    {
        Console.WriteLine();
        Console.WriteLine("| hanging chain, exact, 1/960 s | us/step | ns/joint-step |");
        Console.WriteLine("|---|---|---|");
        double[] sizes = { 64, 256, 1024 };
        var times = new double[sizes.Length];
        for (int i = 0; i < sizes.Length; i++)
        {
            times[i] = Chain((int)sizes[i]);
            Console.WriteLine(string.Format(CultureInfo.InvariantCulture, "| {0} bars | {1:F1} | {2:F0} |", sizes[i], times[i], times[i] * 1000 / sizes[i]));
        }

        double exponent = Math.Log(times[^1] / times[0]) / Math.Log(sizes[^1] / sizes[0]);
        Console.WriteLine();
        Console.WriteLine(string.Format(CultureInfo.InvariantCulture, "Growth from 64 to 1024 bars: exponent {0:F2}.", exponent));
    }

    private static double Chain(int links)
    {
        double best = double.PositiveInfinity;
        for (int run = 0; run < Runs; run++)
        {
            MultibodySystem chain = SolverScenes.HangingChain(links);
            var solver = new RattleSolver(chain);
            double sum = 0;
            for (int i = 0; i < Steps; i++)
            {
                long before = Stopwatch.GetTimestamp();
                solver.Step(Dt);
                sum += Stopwatch.GetElapsedTime(before).TotalMicroseconds;
            }

            best = Math.Min(best, sum / Steps);
        }

        return best;
    }
}
