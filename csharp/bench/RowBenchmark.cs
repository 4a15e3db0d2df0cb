using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using Kinefab.Bench.Peers;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Tests.Dynamics.Rattle;

namespace Kinefab.Bench;

/// <summary>What limits, drives and couplings cost the exact solver: islands with them against the same without, by turns.</summary>
internal static class RowBenchmark
{
    private const double Dt = 1.0 / 60;
    private const int Islands = 240;
    private const int Steps = 240;
    private const int Runs = 9;

    public static void Run()
    {
        Console.WriteLine("| rows | lanes | us/step | without | ratio | spread |");
        Console.WriteLine("|---|---|---|---|---|---|");
        foreach (int width in new[] { 1, 4, 8 })
        {
            var bare = new Timing(() => RowScenes.Pendulums(Islands), width);
            List<(string Name, Timing Timing)> kinds = RowScenes.Kinds.Select(k => (k.Key, new Timing(() => RowScenes.Pendulums(Islands, k.Value), width))).ToList();
            for (int run = 0; run < Runs; run++)
            {
                bare.Run();
                kinds.ForEach(k => k.Timing.Run());
            }

            foreach ((string name, Timing with) in kinds)
            {
                Console.WriteLine(string.Create(
                    CultureInfo.InvariantCulture,
                    $"| {name} | {width} | {with.Least / Steps:F1} | {bare.Least / Steps:F1} | {with.Least / bare.Least:F2} | {with.Spread * 100:F0} % |"));
            }
        }

        Console.WriteLine($"\n{Islands} double pendulums of hinges, {Steps} steps of 1/60 s. Processor time of the thread, every step's least of {Runs} runs by turns; spread: the slowest run over the fastest. {Machine.Description}.");
    }

    private sealed class Timing
    {
        private readonly Func<MultibodySystem> _make;
        private readonly int _width;
        private readonly double[] _best = Enumerable.Repeat(double.PositiveInfinity, Steps).ToArray();
        private readonly List<double> _totals = new();

        public Timing(Func<MultibodySystem> make, int width)
        {
            _make = make;
            _width = width;
        }

        /// <summary>us of all steps, each undisturbed.</summary>
        public double Least => _best.Sum();

        public double Spread => _totals.Max() / _totals.Min() - 1;

        public void Run()
        {
            var solver = new RattleSolver(_make(), _width);
            double total = 0;
            for (int i = 0; i < Steps; i++)
            {
                double before = ThreadClock.Microseconds;
                solver.Step(Dt);
                double time = ThreadClock.Microseconds - before;
                _best[i] = Math.Min(_best[i], time);
                total += time;
            }

            _totals.Add(total);
        }
    }
}
