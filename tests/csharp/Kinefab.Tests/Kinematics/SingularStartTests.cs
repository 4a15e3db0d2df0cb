using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Kinematics;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>
/// Mechanisms exported at poses where branches meet or a driver stands at its dead centre: every joint can be driven off
/// them, along a branch that is stated.
/// </summary>
public class SingularStartTests
{
    // Bars of a parallelogram, and the cranks of M39, turn alike; what joins them keeps its direction.
    [TestCase("M05", 0.5)]
    [TestCase("M39", 1)]
    public void Drive_FlatParallelograms_TurnAsParallelogramsWhicheverJointIsDriven(string id, double crank)
    {
        foreach (int driven in Enumerable.Range(0, new ExportedMechanism(id).Mechanism.Coordinates.Count))
        {
            var exported = new ExportedMechanism(id);
            string name = exported.Mechanism.Coordinates[driven].Name;
            foreach (double angle in new[] { 0.0, 25, 90, 180, 260, 360, 180, 100, 0 })
            {
                DriveResult result = exported.Solver.Drive(exported.State, driven, angle);
                Assert.That(result.Converged, Is.True, $"{name} to {angle}: {result.Status}");
                Assert.That(result.Branches > 0, Is.EqualTo(angle == 25), $"{name} at {angle}");
                for (int i = 0; i < exported.Mechanism.Coordinates.Count; i++)
                {
                    Assert.That(Math.Abs(exported.State.Coordinate(i)), Is.EqualTo(angle).Within(1e-7), $"{exported.Mechanism.Coordinates[i].Name} with {name} at {angle}");
                }

                string[] levels = id == "M05" ? ["coupler"] : ["h0", "h1"];
                foreach (string level in levels)
                {
                    Assert.That(exported.Angle(level), Is.EqualTo(0).Within(1e-7), $"{level} with {name} at {angle}");
                    double turn = exported.Value(id == "M05" ? "crank" : "v0", Coordinate.Angle) * Math.PI / 180;
                    double foot = level == "h1" ? 1 : 0;
                    Assert.That(exported.Position(level).X, Is.EqualTo(foot + crank * Math.Cos(turn)).Within(1e-9), $"{level} with {name} at {angle}");
                    Assert.That(exported.Position(level).Y, Is.EqualTo(crank * Math.Sin(turn)).Within(1e-9), $"{level} with {name} at {angle}");
                }
            }
        }
    }

    // The crossed parallelogram: tan(r/2) = -(d + a) / (d - a) tan(q/2).
    [Test]
    public void Branches_FlatParallelogram_HoldTheCrossedOneAndItCanBeTaken()
    {
        var exported = new ExportedMechanism("M05");
        int crank = exported.Mechanism.CoordinateNamed("crank");
        int rocker = exported.Mechanism.CoordinateNamed("rocker[1]");
        IReadOnlyList<MotionBranch> branches = exported.Solver.Branches(exported.State, crank);
        Assert.That(branches.Select(b => Math.Round(b.Rates[rocker], 2)), Is.EqualTo(new[] { 1.0, -3.0 }));

        exported.State.CopyFrom(branches[1].State);
        foreach (double angle in new[] { 10.0, 75, 120 })
        {
            Assert.That(exported.Solver.Drive(exported.State, crank, angle).Converged, Is.True);
            double expected = 2 * Math.Atan(-3 * Math.Tan(angle * Math.PI / 360)) * 180 / Math.PI;
            Assert.That(exported.State.Coordinate(rocker), Is.EqualTo(expected).Within(1e-7));
        }
    }

    [TestCase(0.01)]
    [TestCase(0.0005)]
    public void Drive_OffAFlatPoseByTinySteps_KeepsToTheBranch(double step)
    {
        var exported = new ExportedMechanism("M05");
        int driven = exported.Mechanism.CoordinateNamed("rocker[1]");
        for (int i = 1; i <= 200; i++)
        {
            Assert.That(exported.Solver.Drive(exported.State, driven, step * i).Converged, Is.True);
        }

        Assert.That(exported.Value("crank", Coordinate.Angle), Is.EqualTo(200 * step).Within(1e-6));
    }

    [Test]
    public void Branches_RegularPose_AreOne()
    {
        var exported = new ExportedMechanism("M01");
        Assert.That(exported.Solver.Branches(exported.State, 0), Has.Count.EqualTo(1));
        Assert.That(exported.Solver.Drive(exported.State, 0, 30).Branches, Is.Zero);
    }

    // M41 stands where coupler and rocker are in one line: the crank turns back, either way of the knee is open.
    [Test]
    public void Sweep_FromADeadCentre_EndsThereOnOneSideAndFindsBothKneesOnTheOther()
    {
        var exported = new ExportedMechanism("M41");
        (RangeLimit low, RangeLimit high) = exported.Range("crank");
        SweepResult swept = exported.Sweep("crank", -30, 12);
        using (Assert.EnterMultipleScope())
        {
            Assert.That((high.End, low.End), Is.EqualTo((RangeEnd.Fold, RangeEnd.Fold)));
            Assert.That(high.Value, Is.EqualTo(0).Within(1e-6));
            Assert.That(low.Value, Is.EqualTo(-2 * 94.0960437582).Within(1e-6));
            Assert.That(exported.Solver.Branches(exported.Mechanism.NewState(), exported.Find("crank", Coordinate.Angle), isRising: true), Is.Empty);
            Assert.That(swept.Branches, Has.Count.EqualTo(2));
            Assert.That(swept.Stop, Is.Null);
            Assert.That(swept.Jumps, Is.Empty);
        }
    }

    // Singular at every pose of its motion, M17 gives Newton's method nothing to hold on to: a drive ends, closed, and says so.
    [Test]
    public void Drive_MechanismThatIsSingularEverywhere_EndsClosedInBoundedTime()
    {
        var exported = new ExportedMechanism("M17");
        for (int i = 0; i < exported.Mechanism.Coordinates.Count; i += 5)
        {
            MechanismState state = exported.Mechanism.NewState();
            DriveResult result = exported.Solver.Drive(state, i, 3);
            Assert.That(result.Status, Is.EqualTo(DriveStatus.Reached).Or.EqualTo(DriveStatus.OutOfReach));
            Assert.That(result.ErrorMetres, Is.LessThan(1e-9));
            Assert.That(result.Iterations, Is.LessThan(40_000));
        }
    }

    [Test]
    public void Drive_OffAFlatPose_GivesTheSameBits()
    {
        MechanismState first = Run();
        MechanismState second = Run();
        for (int i = 0; i < first.Mechanism.Coordinates.Count; i++)
        {
            Assert.That(first.Coordinate(i), Is.EqualTo(second.Coordinate(i)));
        }

        static MechanismState Run()
        {
            var exported = new ExportedMechanism("M39");
            exported.Solver.Drive(exported.State, 4, 77);
            return exported.State;
        }
    }
}
