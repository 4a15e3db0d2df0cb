using System;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>An island's account of energy, and what it holds its motion to.</summary>
internal sealed class EnergyLedgerTests
{
    private const double Largest = 1000;

    [TestCase(19, false, true)]
    [TestCase(21, true, false)]
    [TestCase(-21, false, false)]
    [TestCase(-21, true, true)]
    [TestCase(double.NaN, true, false)]
    public void Allows_AGain_WithinAShareOfTheLargestEnergy(double gain, bool mayLose, bool isAllowed)
    {
        EnergyLedger ledger = default;
        ledger.Enter(0, Largest, Largest, false);
        Assert.That(ledger.Allows(gain, 1, mayLose), Is.EqualTo(isAllowed));
    }

    [TestCase(0.1)]
    [TestCase(-0.1)]
    public void Enter_WhatGathers_IsPutRight(double change)
    {
        EnergyLedger ledger = default;
        double energy = 0;
        for (int i = 0; i < 1000; i++)
        {
            energy += change;
            energy -= ledger.Enter(change, Largest, Largest, false);
            Assert.That(energy, Is.InRange(-1e-2 * Largest - 1e-9, 5e-4 * Largest + 1e-9));
        }
    }

    /// <summary>A symplectic method's energy swings by the square of the step: putting that right would cost it its order.</summary>
    [Test]
    public void Enter_WhatSwingsBelowAndComesBack_IsLeftAlone()
    {
        EnergyLedger ledger = default;
        double energy = 0;
        for (int i = 1; i <= 100; i++)
        {
            double next = 4e-3 * Largest * (Math.Cos(i / 4.0) - 1);
            Assert.That(ledger.Enter(next - energy, Largest, Largest, false), Is.Zero);
            energy = next;
        }
    }

    /// <summary>Else each swing would leave a motion with less than the one before.</summary>
    [Test]
    public void Enter_WhatWasTakenAboveIsGivenBackBelow()
    {
        EnergyLedger ledger = default;
        double energy = 0, swing = 0;
        for (int i = 1; i <= 1000; i++)
        {
            double next = 3e-3 * Largest * Math.Sin(i / 5.0);
            energy += next - swing;
            energy -= ledger.Enter(next - swing, Largest, Largest, false);
            swing = next;
            Assert.That(energy, Is.InRange(-6e-3 * Largest, 5e-4 * Largest + 1e-9), $"step {i}");
        }
    }

    [Test]
    public void Enter_WhereLittleMoves_TakesTheRestLater()
    {
        EnergyLedger ledger = default;
        double taken = ledger.Enter(2, Largest, 1, false);
        Assert.That(taken, Is.EqualTo(0.5));
        Assert.That(taken + ledger.Enter(0, Largest, Largest, false), Is.EqualTo(1.5));
    }

    /// <summary>A step that leaves more than its end's speeds can give is too coarse, though its gain alone is not.</summary>
    [TestCase(0.9, 0, true)]
    [TestCase(1.1, 0, false)]
    [TestCase(1.1, 0.4, true)]
    [TestCase(double.NaN, 1, false)]
    public void CanTake_WhatIsBeyondTwiceTheRoom_OnlyFromSpeeds(double gain, double takeable, bool canTake)
    {
        EnergyLedger ledger = default;
        ledger.Enter(0, Largest, Largest, false);
        Assert.That(ledger.Allows(gain, 1, false), Is.EqualTo(!double.IsNaN(gain)));
        Assert.That(ledger.CanTake(gain, 1, takeable), Is.EqualTo(canTake));
    }

    /// <summary>What a limit took is neither given back nor room for a gain.</summary>
    [Test]
    public void Enter_AfterABlow_LeavesNoRoom()
    {
        EnergyLedger ledger = default;
        ledger.Enter(-500, Largest, Largest, true);
        double energy = 0, highest = 0;
        for (int i = 0; i < 100; i++)
        {
            energy += 0.1;
            energy -= ledger.Enter(0.1, Largest, Largest, false);
            highest = Math.Max(highest, energy);
        }

        Assert.That(highest, Is.LessThanOrEqualTo(1e-3 * Largest));
        for (int i = 0; i < 4; i++)
        {
            Assert.That(ledger.Enter(-0.1, Largest, Largest, false), Is.GreaterThanOrEqualTo(0));
        }
    }

    /// <summary>Loops without limits were not audited in lanes: of these, in steps of 1/30 s, the energy of some swung by more than this.</summary>
    [TestCase(1)]
    [TestCase(4)]
    [TestCase(8)]
    public void Step_CoarseFourBars_KeepEnergyInAnyNumberOfLanes(int lanes)
    {
        const double dt = 1 / 30.0;
        MultibodySystem m = SolverScenes.FourBars(9);
        var solver = new RattleSolver(m, lanes);
        double start = MechanismMeasures.Energy(m);
        double largest = MechanismMeasures.FallEnergy(m, 2 * dt);
        for (int i = 0; i < 300; i++)
        {
            solver.Step(dt);
            largest = Math.Max(largest, MechanismMeasures.Kinetic(m));
            Assert.That((MechanismMeasures.Energy(m) - start) / largest, Is.InRange(-1e-2, 1e-3), $"step {i}");
        }
    }

    /// <summary>
    /// A pendulum of millimetres that swings in a dozen steps: where it turns round no speed is left to take, and it came 13 % of its swing higher than it was
    /// let go.
    /// </summary>
    [Test]
    public void Step_ATinyPendulum_ComesNoHigherThanItWasLetGo([Values(0.004, 0.005, 0.007, 0.01)] double length, [Values(1, 8)] int count)
    {
        const double dt = 0.02, mass = 0.07, angle = Math.PI / 6;
        var b = new MechanismBuilder();
        for (int i = 0; i < count; i++)
        {
            var anchor = new Vector3d(0.1 * i, 0, 0);
            double moment = 0.4 * mass * length * length;
            int bob = b.Body(anchor + new Vector3d(Math.Sin(angle), -Math.Cos(angle), 0) * length, Quaterniond.Identity, mass, new Vector3d(moment, moment, moment));
            b.Hinge(JointModel.World, bob, anchor, Vector3d.UnitZ);
        }

        MultibodySystem m = b.Build();
        var solver = new RattleSolver(m);
        double start = MechanismMeasures.Energy(m), most = 0;
        for (int i = 0; i < 200; i++)
        {
            solver.Step(dt);
            most = Math.Max(most, MechanismMeasures.Kinetic(m));
            double gain = MechanismMeasures.Energy(m) - start;
            Assert.That(gain, Is.LessThanOrEqualTo(1e-3 * (most + MechanismMeasures.FallEnergy(m, 2 * dt))), $"step {i}");
        }
    }

    /// <summary>As the Ground of an exported scene, which is a kinematic body.</summary>
    [TestCase(false)]
    [TestCase(true)]
    public void Step_OnAKinematicBodyThatStands_KeepsEnergyAsOnTheWorld(bool isWorld)
    {
        const double dt = 1.0 / 60;
        var b = new MechanismBuilder();
        Quaterniond turn = Quaterniond.AxisAngle(new Vector3d(1, 2, 3).Normalized(), 1.1);
        int ground = b.Body(new Vector3d(0.3, 0.2, 0.1), turn, 1, new Vector3d(1, 1, 1));
        b.Change(ground, body => body with { IsKinematic = true });
        int fixedTo = isWorld ? JointModel.World : ground;

        // Both stand, nearly, over their hinges.
        int small = b.Body(new Vector3d(0.0015, 0.015, 0), Quaterniond.Identity, 0.0035, new Vector3d(1e-7, 1.5e-7, 1.6e-7));
        int large = b.Body(new Vector3d(0.1, 0.02, 0), Quaterniond.Identity, 0.017, new Vector3d(1.3e-6, 3.7e-6, 3e-6));
        RevoluteJoint first = b.Hinge(fixedTo, small, Vector3d.Zero, Vector3d.UnitZ);
        RevoluteJoint second = b.Hinge(fixedTo, large, new Vector3d(0.1, 0, 0), Vector3d.UnitZ);
        b.Couple(second, (first, -1.45));
        MultibodySystem m = b.Build();
        var solver = new RattleSolver(m);
        double start = Energy(), most = 0;
        for (int i = 0; i < 300; i++)
        {
            solver.Step(dt);
            most = Math.Max(most, MechanismMeasures.Kinetic(m));
            Assert.That(Energy() - start, Is.LessThanOrEqualTo(1e-3 * (most + MechanismMeasures.FallEnergy(m, 2 * dt))), $"step {i}");
        }

        double Energy() => MechanismMeasures.Kinetic(m) + MechanismMeasures.Potential(m);
    }
}
