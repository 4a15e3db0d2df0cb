using System;
using Kinefab.Dynamics.Exact;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Exact;

/// <summary>Published multibody benchmarks within 1e-6 at a stated step, and of second order.</summary>
internal sealed class BenchmarkTests
{
    private static readonly TestCaseData[] Cases =
    {
        Case(BenchmarkMechanisms.Pendulum, 1e-4, 10, "B1"),
        Case(() => BenchmarkMechanisms.Windows(2), 2.5e-4, 2, "B2 N=2, five singular poses"),
        Case(BenchmarkMechanisms.Bricard, 5e-4, 10, "B4"),
        Case(BenchmarkMechanisms.Governor, 4e-5, 0.5, "B5"),
        Case(BenchmarkMechanisms.DoublePendulum, 1e-4, 3, "B7"),
        Case(BenchmarkMechanisms.Flip, 5e-4, 10, "B9"),
        Case(BenchmarkMechanisms.FourBar, 2e-4, 2, "B10"),
        Case(BenchmarkMechanisms.Lever, 2e-4, 0.5, "B11"),
        Case(BenchmarkMechanisms.Squeezer, 1.25e-6, 0.01, "B3"),
    };

    [TestCaseSource(nameof(Cases))]
    public void Step_Benchmark_WithinAMillionth(Func<BenchmarkMechanism> make, double dt, double end)
    {
        BenchmarkMechanism benchmark = make();
        var solver = new ExactSolver(benchmark.MultibodySystem);
        Assert.That(BenchmarkReferences.Deviation(benchmark, solver, dt, end), Is.LessThanOrEqualTo(1e-6));
    }

    [TestCaseSource(nameof(Cases))]
    public void Step_HalfTheStep_AQuarterOfTheError(Func<BenchmarkMechanism> make, double dt, double end)
    {
        BenchmarkMechanism coarse = make();
        BenchmarkMechanism fine = make();
        double at4 = BenchmarkReferences.Deviation(coarse, new ExactSolver(coarse.MultibodySystem), 4 * dt, Math.Min(end, 2));
        double at2 = BenchmarkReferences.Deviation(fine, new ExactSolver(fine.MultibodySystem), 2 * dt, Math.Min(end, 2));
        Assert.That(at4 / at2, Is.GreaterThan(2.8));
    }

    [Test]
    public void Step_FortyWindows_PassTheirSingularPoses()
    {
        BenchmarkMechanism benchmark = BenchmarkMechanisms.Windows(40);
        Assert.That(BenchmarkReferences.Deviation(benchmark, new ExactSolver(benchmark.MultibodySystem), 2.5e-3, 2), Is.LessThanOrEqualTo(1e-4));
        Assert.That(MechanismMeasures.Drift(benchmark.MultibodySystem), Is.LessThanOrEqualTo(1e-8));
    }

    private static TestCaseData Case(Func<BenchmarkMechanism> make, double dt, double end, string name) =>
        new TestCaseData(make, dt, end).SetArgDisplayNames(name);
}
