using System;
using System.Diagnostics;
using System.Globalization;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Dynamics.Pgs;
using Kinefab.Tests.Dynamics.Rattle;

namespace Kinefab.Bench;

/// <summary>Time, drift and energy of the solvers on the same scenes, side by side: 10 s of motion at 1/60 s.</summary>
internal static class SolverBenchmark
{
    private const double Dt = 1.0 / 60;
    private const int Steps = 600;
    private const int Runs = 5;

    // Small scenes are long over before the runtime has compiled them in full: it waits 0.1 s after the last method it met.
    private static readonly TimeSpan Least = TimeSpan.FromSeconds(2);

    public static void Run()
    {
        Console.WriteLine("| scene | solver | us/step | ns/joint-step | drift m | energy end % (max) |");
        Console.WriteLine("|---|---|---|---|---|---|");
        Row("fourbar100", "unity", () => SolverScenes.FourBars(100), m => new PgsSolver(m), 100 * 1.7 * 9.81);
        Row("dpend1000", "unity", () => SolverScenes.DoublePendulums(1000), m => new PgsSolver(m), 1000 * 9.81 * 2);
        foreach (int width in new[] { 1, 4, 8 })
        {
            string name = $"exact, {width} lanes";
            Row("fourbar100", name, () => SolverScenes.FourBars(100), m => new RattleSolver(m, width), 100 * 1.7 * 9.81);
            Row("dpend1000", name, () => SolverScenes.DoublePendulums(1000), m => new RattleSolver(m, width), 1000 * 9.81 * 2);
        }

        Row("slidercrank", "unity", SolverScenes.SliderCrank, m => new PgsSolver(m), null);
        Row("slidercrank", "exact", SolverScenes.SliderCrank, m => new RattleSolver(m), null);
        Row("chain64", "exact", () => SolverScenes.Chain(64), m => new RattleSolver(m), 64 * 9.81 * 6.4);
        Row("heavy8", "exact", SolverScenes.Heavy8, m => new RattleSolver(m), 10.7 * 9.81 * 1.6);
        Row("para", "exact", SolverScenes.Parallelogram, m => new RattleSolver(m), null);
        Row("tilt 1e-6", "exact", () => SolverScenes.FourBars(1, 1e-6), m => new RattleSolver(m), 1.7 * 9.81);
        Row("tilt 1e-4", "exact", () => SolverScenes.FourBars(1, 1e-4), m => new RattleSolver(m), 1.7 * 9.81);
        Row("tilt 1e-2", "exact", () => SolverScenes.FourBars(1, 1e-2), m => new RattleSolver(m), 1.7 * 9.81);
    }

    /// <param name="energyScale">What 100 % of energy is, J; null where a motor does work and the energy says nothing.</param>
    private static void Row(string scene, string name, Func<MultibodySystem> make, Func<MultibodySystem, ISolver> solver, double? energyScale)
    {
        MultibodySystem mechanism = make();
        ISolver judged = solver(mechanism);
        double start = MechanismMeasures.Energy(mechanism);
        double drift = 0, most = 0, end = 0;
        for (int i = 0; i < Steps; i++)
        {
            judged.Step(Dt);
            drift = Math.Max(drift, MechanismMeasures.Drift(mechanism));
            end = (MechanismMeasures.Energy(mechanism) - start) / (energyScale ?? 1) * 100;
            most = Math.Abs(end) > Math.Abs(most) ? end : most;
        }

        // Every step's best time of some runs: a whole run is never undisturbed.
        var best = new double[Steps];
        Array.Fill(best, double.PositiveInfinity);
        long began = Stopwatch.GetTimestamp();
        for (int run = 0; run < Runs || Stopwatch.GetElapsedTime(began) < Least; run++)
        {
            mechanism = make();
            ISolver timed = solver(mechanism);
            for (int i = 0; i < Steps; i++)
            {
                long before = Stopwatch.GetTimestamp();
                timed.Step(Dt);
                best[i] = Math.Min(best[i], Stopwatch.GetElapsedTime(before).TotalMicroseconds);
            }
        }

        double mean = 0;
        foreach (double time in best)
        {
            mean += time / Steps;
        }

        string energy = energyScale is null ? "driven" : string.Format(CultureInfo.InvariantCulture, "{0:F3} ({1:F3})", end, most);
        Console.WriteLine(string.Format(
            CultureInfo.InvariantCulture, "| {0} | {1} | {2:F1} | {3:F0} | {4:E1} | {5} |",
            scene, name, mean, mean * 1000 / mechanism.Joints.Length, drift, energy));
    }
}
