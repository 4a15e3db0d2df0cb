using System;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Loops stay closed and energy is kept over 10 s at 1/60 s.</summary>
internal sealed class SceneTests
{
    private const double Dt = 1.0 / 60;
    private const int Steps = 600;

    // Whether nothing but gravity does work; a driven mechanism's energy is its motor's.
    private static readonly TestCaseData[] Scenes =
    {
        Case(() => SolverScenes.FourBars(100), true, "fourbar100"),
        Case(() => SolverScenes.DoublePendulums(1000), true, "dpend1000"),
        Case(() => SolverScenes.Chain(64), true, "chain64"),
        Case(SolverScenes.SliderCrank, false, "slidercrank"),
        Case(SolverScenes.Heavy8, true, "heavy8"),
        Case(SolverScenes.Parallelogram, false, "para"),
        Case(() => SolverScenes.FourBars(1, 1e-6), true, "tilt 1e-6"),
        Case(() => SolverScenes.FourBars(1, 1e-4), true, "tilt 1e-4"),
        Case(() => SolverScenes.FourBars(1, 1e-3), true, "tilt 1e-3"),
        Case(() => SolverScenes.FourBars(1, 1e-2), true, "tilt 1e-2"),
    };

    [TestCaseSource(nameof(Scenes))]
    public void Step_TenSeconds_LeavesNoGapAndMakesNoEnergy(Func<MultibodySystem> make, bool isPassive)
    {
        MultibodySystem mechanism = make();
        var solver = new RattleSolver(mechanism);
        double start = MechanismMeasures.Energy(mechanism);
        double drift = 0;
        double most = start;
        for (int i = 0; i < Steps; i++)
        {
            solver.Step(Dt);
            drift = Math.Max(drift, MechanismMeasures.Drift(mechanism));
            most = Math.Max(most, MechanismMeasures.Energy(mechanism));
        }

        Assert.That(drift, Is.LessThanOrEqualTo(1e-8));
        Assert.That(mechanism.Stops, Is.Zero);
        if (isPassive)
        {
            Assert.That((most - start) / Available(make()), Is.LessThanOrEqualTo(0.005));
        }
    }

    [Test]
    public void Step_FourBars_KeepEnergyToAThousandth()
    {
        Assert.That(EnergyError(() => SolverScenes.FourBars(100)), Is.EqualTo(0).Within(0.001));
    }

    [Test]
    public void Step_DoublePendulums_KeepEnergyThoughTheyWhip()
    {
        Assert.That(EnergyError(() => SolverScenes.DoublePendulums(1000)), Is.EqualTo(0).Within(0.0015));
    }

    [TestCase(1e-3)]
    [TestCase(1e-2)]
    public void Step_TiltedLoop_MovesAsTheTrueOneDoes(double tilt)
    {
        MultibodySystem tilted = SolverScenes.FourBars(1, tilt);
        MultibodySystem exact = SolverScenes.FourBars(1);
        var solver = new RattleSolver(tilted);
        var reference = new RattleSolver(exact);
        double difference = 0;
        double moved = 0;
        Vector3d start = exact.Bodies.Poses[1].Position;
        for (int i = 0; i < 60; i++)
        {
            solver.Step(Dt);
            reference.Step(Dt);
            difference = Math.Max(difference, (tilted.Bodies.Poses[1].Position - exact.Bodies.Poses[1].Position).Length);
            moved = Math.Max(moved, (exact.Bodies.Poses[1].Position - start).Length);
        }

        Assert.That(moved, Is.GreaterThan(0.3));
        Assert.That(difference, Is.LessThanOrEqualTo(0.02 * moved));
        Assert.That(EnergyError(() => SolverScenes.FourBars(1, tilt)), Is.EqualTo(0).Within(0.001));
    }

    [Test]
    public void Step_SliderCrank_HoldsTheMotorsSpeed()
    {
        MultibodySystem mechanism = SolverScenes.SliderCrank();
        var solver = new RattleSolver(mechanism);
        double worst = 0;
        for (int i = 0; i < Steps; i++)
        {
            solver.Step(Dt);
            if (i > 10)
            {
                worst = Math.Max(worst, Math.Abs(mechanism.Bodies.AngularVelocities[0].Z - 2 * Math.PI));
            }
        }

        Assert.That(worst, Is.LessThanOrEqualTo(1e-6));
    }

    [Test]
    public void Step_Parallelogram_TurnsThroughItsChangePoints()
    {
        MultibodySystem mechanism = SolverScenes.Parallelogram();
        var solver = new RattleSolver(mechanism);
        double turned = 0;
        Quaterniond last = mechanism.Bodies.Poses[0].Rotation;
        for (int i = 0; i < Steps; i++)
        {
            solver.Step(Dt);
            Quaterniond now = mechanism.Bodies.Poses[0].Rotation;
            Quaterniond delta = now * last.Conjugate();
            turned += 2 * Math.Atan(delta.Z / delta.W);
            last = now;
        }

        Assert.That(turned, Is.EqualTo(20 * Math.PI).Within(0.01));
    }

    [TestCase(1)]
    [TestCase(4)]
    [TestCase(8)]
    public void Step_AnyLaneWidth_SameBits(int width)
    {
        Assert.That(BitsAfter(SolverScenes.FourBars(9), width), Is.EqualTo(BitsAfter(SolverScenes.FourBars(9), 1)));
        Assert.That(BitsAfter(SolverScenes.DoublePendulums(13), width), Is.EqualTo(BitsAfter(SolverScenes.DoublePendulums(13), 1)));
        Assert.That(BitsAfter(SolverScenes.FourBars(9, 1e-2), width), Is.EqualTo(BitsAfter(SolverScenes.FourBars(9, 1e-2), 1)));
    }

    [Test]
    public void Step_Twice_SameBits()
    {
        ulong first = BitsAfter(SolverScenes.SliderCrank(), 1);
        ulong second = BitsAfter(SolverScenes.SliderCrank(), 1);
        Assert.That(second, Is.EqualTo(first));
    }

    // The tolerance of a step is 1e-9; chaos doubles what it leaves in a fraction of a second, so that long chains part.
    private static readonly TestCaseData[] Orders =
    {
        new TestCaseData((Func<MultibodySystem>)(() => SolverScenes.FourBars(1)), 2.0).SetArgDisplayNames("fourbar"),
        new TestCaseData((Func<MultibodySystem>)(() => SolverScenes.Chain(4)), 1.0).SetArgDisplayNames("chain4"),
        new TestCaseData((Func<MultibodySystem>)SolverScenes.SliderCrank, 2.0).SetArgDisplayNames("slidercrank, a motor"),
        new TestCaseData((Func<MultibodySystem>)(() => BenchmarkMechanisms.Lever().MultibodySystem), 2.0).SetArgDisplayNames("lever"),
        new TestCaseData((Func<MultibodySystem>)(() => BenchmarkMechanisms.Bricard().MultibodySystem), 1.0).SetArgDisplayNames("Bricard"),
        new TestCaseData((Func<MultibodySystem>)(() => BenchmarkMechanisms.Governor().MultibodySystem), 1.0).SetArgDisplayNames("governor, two springs"),
    };

    [TestCaseSource(nameof(Orders))]
    public void Step_JointsAndBodiesInAnotherOrder_SameMotion(Func<MultibodySystem> make, double seconds)
    {
        for (int seed = 0; seed < 3; seed++)
        {
            MultibodySystem first = make();
            MultibodySystem other = make();
            var random = new Random(seed);
            random.Shuffle(other.Joints);
            int[] places = BodyOrder.Shuffle(other, random);
            var solverOne = new RattleSolver(first);
            var solverOther = new RattleSolver(other);
            for (int i = 0; i < (int)(seconds / Dt); i++)
            {
                solverOne.Step(Dt);
                solverOther.Step(Dt);
            }

            for (int b = 0; b < first.Bodies.Count; b++)
            {
                Assert.That((first.Bodies.Poses[b].Position - other.Bodies.Poses[places[b]].Position).Length, Is.LessThanOrEqualTo(1e-9));
            }
        }
    }

    [Test]
    public void Step_AfterWarmUp_AllocatesNothing()
    {
        foreach (MultibodySystem mechanism in new[] { SolverScenes.FourBars(9), SolverScenes.SliderCrank(), SolverScenes.Chain(16) })
        {
            var solver = new RattleSolver(mechanism);
            Action run = () =>
            {
                for (int i = 0; i < 60; i++)
                {
                    solver.Step(Dt);
                }
            };
            run();
            Assert.That(AllocatedBytes.LeastOf(run), Is.Zero);
        }
    }

    // Change over 10 s as a share of the available energy.
    private static double EnergyError(Func<MultibodySystem> make)
    {
        MultibodySystem mechanism = make();
        var solver = new RattleSolver(mechanism);
        double start = MechanismMeasures.Energy(mechanism);
        for (int i = 0; i < Steps; i++)
        {
            solver.Step(Dt);
        }

        return (MechanismMeasures.Energy(mechanism) - start) / Available(make());
    }

    // Weight times the height that the centres of mass could fall if each hung straight down from the first pivot; a
    // crank-rocker's, which is not to hang, no more than half a metre.
    private static double Available(MultibodySystem mechanism)
    {
        double sum = 0;
        for (int i = 0; i < mechanism.Bodies.Count; i++)
        {
            double reach = Math.Min(mechanism.Bodies.Poses[i].Position.X, mechanism.Joints.Length % 4 == 0 && mechanism.Bodies.Count % 3 == 0 ? 0.5 : 100);
            sum += 9.81 / mechanism.Bodies.InverseMasses[i] * Math.Abs(reach);
        }

        return sum;
    }

    private static TestCaseData Case(Func<MultibodySystem> make, bool isPassive, string name) =>
        new TestCaseData(make, isPassive).SetArgDisplayNames(name);

    private static ulong BitsAfter(MultibodySystem mechanism, int width)
    {
        var solver = new RattleSolver(mechanism, width);
        for (int i = 0; i < 300; i++)
        {
            solver.Step(Dt);
        }

        return MechanismMeasures.Bits(mechanism);
    }
}
