using System;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Exact;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Exact;

/// <summary>Loops stay closed and energy is kept over 10 s at 1/60 s.</summary>
internal sealed class SceneTests
{
    private const double Dt = 1.0 / 60;
    private const int Steps = 600;

    // Each with the share of its energy that it may gain: a whip's substeps change their length, which costs RATTLE part of
    // its symplectic behaviour; a driven mechanism's energy is its motor's.
    private static readonly TestCaseData[] Scenes =
    {
        new TestCaseData((Func<MultibodySystem>)(() => SolverScenes.FourBars(4)), 0.005).SetArgDisplayNames("fourbar"),
        new TestCaseData((Func<MultibodySystem>)(() => SolverScenes.DoublePendulums(4)), 0.005).SetArgDisplayNames("dpend"),
        new TestCaseData((Func<MultibodySystem>)(() => SolverScenes.Chain(64)), 0.03).SetArgDisplayNames("chain64"),
        new TestCaseData((Func<MultibodySystem>)SolverScenes.SliderCrank, double.PositiveInfinity).SetArgDisplayNames("slidercrank"),
        new TestCaseData((Func<MultibodySystem>)SolverScenes.Heavy8, 0.03).SetArgDisplayNames("heavy8"),
        new TestCaseData((Func<MultibodySystem>)SolverScenes.Parallelogram, double.PositiveInfinity).SetArgDisplayNames("para"),
        new TestCaseData((Func<MultibodySystem>)(() => SolverScenes.FourBars(1, 1e-6)), 0.005).SetArgDisplayNames("tilt 1e-6"),
        new TestCaseData((Func<MultibodySystem>)(() => SolverScenes.FourBars(1, 1e-4)), 0.01).SetArgDisplayNames("tilt 1e-4"),
    };

    [TestCaseSource(nameof(Scenes))]
    public void Step_TenSeconds_LeavesNoGapAndMakesNoEnergy(Func<MultibodySystem> make, double mostGain)
    {
        MultibodySystem mechanism = make();
        var solver = new ExactSolver(mechanism);
        double start = MechanismMeasures.Energy(mechanism);
        double available = Available(mechanism);
        double drift = 0;
        double gain = 0;
        for (int i = 0; i < Steps; i++)
        {
            solver.Step(Dt);
            drift = Math.Max(drift, MechanismMeasures.Drift(mechanism));
            gain = Math.Max(gain, (MechanismMeasures.Energy(mechanism) - start) / available);
        }

        Assert.That(drift, Is.LessThanOrEqualTo(1e-8));
        // A loop that is off by 1e-4 rad can bind for a substep; elsewhere the solver always finds a step.
        Assert.That(mechanism.Overflows, Is.LessThanOrEqualTo(Steps / 100));
        Assert.That(gain, Is.LessThanOrEqualTo(mostGain));
    }

    [Test]
    public void Step_FourBars_KeepsEnergyToAThousandth()
    {
        MultibodySystem mechanism = SolverScenes.FourBars(8);
        Assert.That(EnergyError(mechanism), Is.EqualTo(0).Within(0.001));
    }

    [Test]
    public void Step_DoublePendulums_LoseLittleEnergy()
    {
        // Released from the horizontal they whip; the steps that the whips cut short cost up to 3 percent in 10 s.
        MultibodySystem mechanism = SolverScenes.DoublePendulums(8);
        Assert.That(EnergyError(mechanism), Is.InRange(-0.03, 0.0));
    }

    [Test]
    public void Step_SliderCrank_HoldsTheMotorsSpeed()
    {
        MultibodySystem mechanism = SolverScenes.SliderCrank();
        var solver = new ExactSolver(mechanism);
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
        var solver = new ExactSolver(mechanism);
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
    }

    [Test]
    public void Step_Twice_SameBits()
    {
        ulong first = BitsAfter(SolverScenes.SliderCrank(), 1);
        ulong second = BitsAfter(SolverScenes.SliderCrank(), 1);
        Assert.That(second, Is.EqualTo(first));
    }

    [Test]
    public void Step_JointsInAnotherOrder_SameMotion()
    {
        MultibodySystem one = SolverScenes.FourBars(1);
        MultibodySystem other = SolverScenes.FourBars(1);
        Array.Reverse(other.Joints);
        var solverOne = new ExactSolver(one);
        var solverOther = new ExactSolver(other);
        for (int i = 0; i < 120; i++)
        {
            solverOne.Step(Dt);
            solverOther.Step(Dt);
        }

        for (int b = 0; b < one.Bodies.Count; b++)
        {
            Assert.That((one.Bodies.Poses[b].Position - other.Bodies.Poses[b].Position).Length, Is.LessThanOrEqualTo(1e-9));
        }
    }

    [Test]
    public void Step_AfterWarmUp_AllocatesNothing()
    {
        foreach (MultibodySystem mechanism in new[] { SolverScenes.FourBars(9), SolverScenes.SliderCrank(), SolverScenes.Chain(16) })
        {
            var solver = new ExactSolver(mechanism);
            for (int i = 0; i < 60; i++)
            {
                solver.Step(Dt);
            }

            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int i = 0; i < 60; i++)
            {
                solver.Step(Dt);
            }

            Assert.That(GC.GetAllocatedBytesForCurrentThread() - before, Is.Zero);
        }
    }

    private static double EnergyError(MultibodySystem mechanism)
    {
        var solver = new ExactSolver(mechanism);
        double start = MechanismMeasures.Energy(mechanism);
        double available = Available(mechanism);
        for (int i = 0; i < Steps; i++)
        {
            solver.Step(Dt);
        }

        return (MechanismMeasures.Energy(mechanism) - start) / available;
    }

    // Weight times the height that the centres of mass could fall if each hung straight down from the first pivot; a
    // crank-rocker's from its start to its lowest.
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

    private static ulong BitsAfter(MultibodySystem mechanism, int width)
    {
        var solver = new ExactSolver(mechanism, width);
        for (int i = 0; i < 300; i++)
        {
            solver.Step(Dt);
        }

        return MechanismMeasures.Bits(mechanism);
    }
}
