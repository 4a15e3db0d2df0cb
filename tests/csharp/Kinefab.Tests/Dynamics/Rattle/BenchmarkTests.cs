using System;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using Kinefab.Dynamics.Rattle;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Published multibody benchmarks within 1e-6 of their eight digits at a stated step, and of second order.</summary>
internal sealed class BenchmarkTests
{
    // Step, and time up to which all reference values are met. B2 lies flat, its constraints dependent, once each half turn:
    // what a tolerance leaves is amplified there, so that errors below 1e-6 depend on where the steps fall (5e-7 to 7e-7 from
    // 1.6e-4 s down). B7 is chaotic: its references end at 3 s.
    private static readonly Convergence[] Benchmarks =
    {
        new("B1", "pendulum", BenchmarkMechanisms.Pendulum, 1e-4, 10),
        new("B2", "two four-bar windows, through singular poses", () => BenchmarkMechanisms.Windows(2), 1.25e-4, 10),
        new("B3", "Andrews' squeezer", BenchmarkMechanisms.Squeezer, 8e-7, 0.05),
        new("B4", "Bricard loop, one row redundant", BenchmarkMechanisms.Bricard, 5e-4, 10),
        new("B5", "flyball governor, stiff", BenchmarkMechanisms.Governor, 6.25e-5, 10),
        new("B7", "double pendulum", BenchmarkMechanisms.DoublePendulum, 1e-4, 3),
        new("B9", "free body about its middle axis", BenchmarkMechanisms.Flip, 2e-3, 10),
        new("B10", "four-bar", BenchmarkMechanisms.FourBar, 2.5e-4, 2),
        new("B11", "lever and slider-crank", BenchmarkMechanisms.Lever, 2e-4, 0.5),
    };

    [TestCaseSource(nameof(Benchmarks))]
    public void Step_Benchmark_WithinAMillionth(Convergence benchmark)
    {
        Assert.That(benchmark.Errors[2], Is.LessThanOrEqualTo(1e-6));
    }

    [TestCaseSource(nameof(Benchmarks))]
    public void Step_HalfTheStep_AQuarterOfTheError(Convergence benchmark)
    {
        Assert.That(benchmark.Errors[0] / benchmark.Errors[1], Is.EqualTo(4).Within(0.3));
        Assert.That(benchmark.Errors[1] / benchmark.Errors[2], Is.EqualTo(4).Within(0.3));
    }

    [Test]
    public void Step_FortyWindows_PassTheirSingularPoses()
    {
        BenchmarkMechanism benchmark = BenchmarkMechanisms.Windows(40);
        Assert.That(BenchmarkReferences.Deviation(benchmark, new RattleSolver(benchmark.MultibodySystem), 2.5e-3, 2), Is.LessThanOrEqualTo(1e-4));
        Assert.That(MechanismMeasures.Drift(benchmark.MultibodySystem), Is.LessThanOrEqualTo(1e-8));
    }

    [Test]
    public void Document_ConvergenceTable_NamesEveryBenchmark()
    {
        string path = Path.Combine(BenchmarkReferences.Root(), "tests", "reference", "CONVERGENCE.md");
        if (Environment.GetEnvironmentVariable("KINEFAB_WRITE_TABLES") == "1")
        {
            File.WriteAllText(path, Table());
        }

        string text = File.ReadAllText(path);
        Assert.That(Benchmarks.Select(b => $"| {b.Id}: {b.About} | {Convergence.Text(b.Dt)} |"), Is.All.Matches<string>(row => text.Contains(row!, StringComparison.Ordinal)));
    }

    private static string Table()
    {
        var text = new StringBuilder();
        text.Append("# `Exact` against benchmarks of known motion\n\n");
        text.Append("Generated: `KINEFAB_WRITE_TABLES=1 dotnet test csharp/Kinefab.slnx --filter Name=Document_ConvergenceTable_NamesEveryBenchmark`.\n");
        text.Append("Largest error over all reference values (m, rad, rad/s; `dynamics/benchmarks.csv`, eight digits) up to the time, at a step and at\n");
        text.Append("two and four times it; order: the binary logarithm of the ratio of the errors on halving the step.\n\n");
        text.Append("| benchmark | step s | up to s | error at 4 steps | at 2 steps | at the step | order | order |\n|---|---|---|---|---|---|---|---|\n");
        foreach (Convergence b in Benchmarks)
        {
            double[] e = b.Errors;
            text.Append(CultureInfo.InvariantCulture, $"| {b.Id}: {b.About} | {Convergence.Text(b.Dt)} | {Convergence.Text(b.End)} | {e[0]:0.0e+0} | {e[1]:0.0e+0} | {e[2]:0.0e+0} | {Math.Log2(e[0] / e[1]):0.00} | {Math.Log2(e[1] / e[2]):0.00} |\n");
        }

        return text.ToString();
    }

    /// <summary>A benchmark run at 4, 2 and 1 times a step.</summary>
    internal sealed class Convergence
    {
        private readonly Lazy<double[]> _errors;

        public Convergence(string id, string about, Func<BenchmarkMechanism> make, double dt, double end)
        {
            Id = id;
            About = about;
            Dt = dt;
            End = end;
            _errors = new Lazy<double[]>(() => new[] { Run(make(), 4 * dt, end), Run(make(), 2 * dt, end), Run(make(), dt, end) });
        }

        public string Id { get; }

        public string About { get; }

        public double Dt { get; }

        public double End { get; }

        /// <summary>Largest errors at 4, 2 and 1 times the step.</summary>
        public double[] Errors => _errors.Value;

        public static string Text(double number) => number.ToString(CultureInfo.InvariantCulture);

        public override string ToString() => Id;

        private static double Run(BenchmarkMechanism benchmark, double dt, double end) =>
            BenchmarkReferences.Deviation(benchmark, new RattleSolver(benchmark.MultibodySystem), dt, end);
    }
}
