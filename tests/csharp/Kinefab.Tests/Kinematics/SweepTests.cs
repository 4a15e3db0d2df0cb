using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>Ranges of driven coordinates: dead centres, limits and whole turns, against closed forms.</summary>
public class SweepTests
{
    // cos q = (a^2 + d^2 - (b + c)^2) / (2 a d): coupler and rocker in a line.
    [Test]
    public void Range_NonGrashofCrank_EndsAtItsDeadCentres()
    {
        var bar = new FourBar(0.7, 0.9, 0.8, 1.5, 40);
        (RangeLimit low, RangeLimit high) = new Sweep(new PositionSolver(bar.Mechanism)).Range(bar.Mechanism.NewState(), bar.Drive);
        double limit = Math.Acos((0.49 + 2.25 - 2.89) / (2 * 0.7 * 1.5)) * 180 / Math.PI;
        using (Assert.EnterMultipleScope())
        {
            Assert.That(high.End, Is.EqualTo(RangeEnd.Fold));
            Assert.That(high.Value + 40, Is.EqualTo(limit).Within(1e-7));
            Assert.That(low.End, Is.EqualTo(RangeEnd.Fold));
            Assert.That(low.Value + 40, Is.EqualTo(-limit).Within(1e-7));
        }
    }

    // Angles between rocker and ground: cos = (c^2 + d^2 - (b +- a)^2) / (2 c d).
    [Test]
    public void Range_RockerOfACrankRocker_EndsWhereCrankAndCouplerAlign()
    {
        var bar = new FourBar(0.4, 1.2, 0.8, 1, 60);
        int rocker = bar.RockerJoint.Angle(bar.Mechanism);
        (RangeLimit low, RangeLimit high) = new Sweep(new PositionSolver(bar.Mechanism)).Range(bar.Mechanism.NewState(), rocker);
        double start = bar.Angles(60).Rocker;
        using (Assert.EnterMultipleScope())
        {
            Assert.That(low.End, Is.EqualTo(RangeEnd.Fold));
            Assert.That(low.Value + start, Is.EqualTo(180 - 125.0996321954).Within(1e-7));
            Assert.That(high.End, Is.EqualTo(RangeEnd.Fold));
            Assert.That(high.Value + start, Is.EqualTo(180 - 51.3178125465).Within(1e-7));
        }
    }

    // Stroke of an offset slider-crank: sqrt((l + r)^2 - e^2) - sqrt((l - r)^2 - e^2).
    [Test]
    public void Range_OffsetSlider_IsItsStroke()
    {
        (MechanismScene scene, _, JointPlace slide, _) = PlanarMechanisms.SliderCrank(0.5, 1.5, 0.2, 35);
        Mechanism mechanism = scene.Mechanism();
        int x = slide.In(mechanism, Coordinate.X);
        (RangeLimit low, RangeLimit high) = new Sweep(new PositionSolver(mechanism)).Range(mechanism.NewState(), x);
        Assert.That(high.Value - low.Value, Is.EqualTo(1.0101789771).Within(1e-9));
    }

    [Test]
    public void Range_CrankOfACrankRocker_IsAWholeTurn()
    {
        var bar = new FourBar(0.4, 1.2, 0.8, 1, 25);
        (RangeLimit low, RangeLimit high) = new Sweep(new PositionSolver(bar.Mechanism)).Range(bar.Mechanism.NewState(), bar.Drive);
        Assert.That(low.End, Is.EqualTo(RangeEnd.Open));
        Assert.That(high.End, Is.EqualTo(RangeEnd.Open));
    }

    [Test]
    public void Range_LimitedHinge_EndsAtTheLimits()
    {
        var bar = new FourBar(0.4, 1.2, 0.8, 1, 25, -10, 80);
        (RangeLimit low, RangeLimit high) = new Sweep(new PositionSolver(bar.Mechanism)).Range(bar.Mechanism.NewState(), bar.Drive);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(low.End, Is.EqualTo(RangeEnd.Limit));
            Assert.That(low.Value, Is.EqualTo(-10).Within(1e-9));
            Assert.That(high.Limit?.IsUpper, Is.True);
            Assert.That(high.Value, Is.EqualTo(80).Within(1e-9));
        }
    }

    // A step of the drive is wider than the gap between these limits.
    [TestCase(-180, 180)]
    [TestCase(-179.9, 179.9)]
    [TestCase(-170, 180)]
    public void Range_LimitsThatLeaveANarrowGap_EndsAtTheLimits(double lower, double upper)
    {
        var scene = new MechanismScene();
        JointPlace hinge = scene.Hinge(scene.Body("lid", Vector3d.UnitX), null, Vector3d.Zero, Vector3d.UnitZ, lower, upper);
        Mechanism mechanism = scene.Mechanism();
        (RangeLimit low, RangeLimit high) = new Sweep(new PositionSolver(mechanism)).Range(mechanism.NewState(), hinge.Angle(mechanism));
        using (Assert.EnterMultipleScope())
        {
            Assert.That(low.End, Is.EqualTo(RangeEnd.Limit));
            Assert.That(low.Value, Is.EqualTo(lower).Within(1e-9));
            Assert.That(high.End, Is.EqualTo(RangeEnd.Limit));
            Assert.That(high.Value, Is.EqualTo(upper).Within(1e-9));
        }
    }

    [Test]
    public void Run_WholeTurnOfTheLever_KeepsEveryStateOnTheClosedForm()
    {
        (MechanismScene scene, JointPlace lever, JointPlace slider) = PlanarMechanisms.PaperLever(30, withParts: true);
        Mechanism mechanism = scene.Mechanism();
        SweepResult result = new Sweep(new PositionSolver(mechanism)).Run(mechanism.NewState(), lever.Angle(mechanism), -30, 330, 72);
        double start = 0.25 * Math.Cos(Math.PI / 6) + Math.Sqrt(0.81 - 0.25 * 0.25 * 0.25);
        Assert.That(result.Stop, Is.Null);
        Assert.That(result.Jumps, Is.Empty);
        Assert.That(result.States, Has.Count.EqualTo(73));
        for (int i = 0; i <= 72; i++)
        {
            double q = 5 * i * Math.PI / 180;
            double x = 0.25 * Math.Cos(q) + Math.Sqrt(0.81 - Math.Pow(0.25 * Math.Sin(q), 2));
            Assert.That(result.States[i].Coordinate(slider.In(mechanism, Coordinate.X)) + start, Is.EqualTo(x).Within(1e-9));
        }
    }

    [Test]
    public void Run_PastADeadCentre_StopsThereAndNamesTheFold()
    {
        var bar = new FourBar(0.7, 0.9, 0.8, 1.5, 40);
        SweepResult result = new Sweep(new PositionSolver(bar.Mechanism)).Run(bar.Mechanism.NewState(), bar.Drive, 0, 80, 16);
        Assert.That(result.Stop?.End, Is.EqualTo(RangeEnd.Fold));
        Assert.That(result.Stop?.Value + 40, Is.EqualTo(94.0960437582).Within(1e-6));
        Assert.That(result.States, Has.Count.LessThan(17));
        Assert.That(result.Jumps, Is.Empty);
    }

    [Test]
    public void Find_AtAChangePoint_IsABifurcationNotAFold()
    {
        // One degree before the parallelogram lies flat, looked at along the rocker.
        var bar = new FourBar(0.5, 1, 0.5, 1, 60);
        MechanismState state = bar.Mechanism.NewState();
        var solver = new PositionSolver(bar.Mechanism);
        solver.Drive(state, bar.Drive, 119.99);
        DeadPoint? found = new DeadPointSearch(bar.Mechanism, solver.Newton, solver.Singular).Find(state, bar.Drive, 1);
        Assert.That(found is null || found.Value.Kind == DeadPointKind.Bifurcation);
    }
}
