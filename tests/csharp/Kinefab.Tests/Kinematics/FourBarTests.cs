using System;
using Kinefab.Kinematics;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>Closed forms of planar four-bars (crank-rocker and double crank), numbers from the cosine rule by hand.</summary>
public class FourBarTests
{
    [TestCase(0, 36.3360575146, 62.7203872640)]
    [TestCase(60, 18.3760176636, 64.9434811058)]
    [TestCase(150, 27.2546977717, 110.4593842727)]
    [TestCase(270, 62.4907216388, 123.8597318019)]
    public void Drive_CrankRocker_MeetsClosedForm(double crank, double coupler, double rocker)
    {
        var bar = new FourBar(0.4, 1.2, 0.8, 1, 25);
        AssertPose(bar, crank, coupler, rocker);
    }

    [TestCase(60, -54.7975334437, -8.2300700015)]
    [TestCase(150, 14.1529244961, 97.3576109971)]
    [TestCase(300, 138.3760176636, -175.0565188942)]
    public void Drive_DoubleCrank_MeetsClosedForm(double crank, double coupler, double rocker)
    {
        var bar = new FourBar(1, 1.2, 0.8, 0.4, 25);
        AssertPose(bar, crank, coupler, rocker);
    }

    [Test]
    public void Drive_FullTurnAndBack_ReturnsToTheStart()
    {
        var bar = new FourBar(0.4, 1.2, 0.8, 1, 25);
        MechanismState state = bar.Mechanism.NewState();
        var solver = new PositionSolver(bar.Mechanism);
        foreach (double target in new[] { 90.0, 360, 123, 0 })
        {
            Assert.That(solver.Drive(state, bar.Drive, target).Converged, Is.True);
        }

        MechanismState start = bar.Mechanism.NewState();
        for (int body = 0; body < 3; body++)
        {
            Assert.That((state.Pose(body).Position - start.Pose(body).Position).Length, Is.LessThan(1e-9));
        }

        for (int i = 0; i < bar.Mechanism.Coordinates.Count; i++)
        {
            Assert.That(state.Coordinate(i), Is.EqualTo(0).Within(1e-9));
        }
    }

    private static void AssertPose(FourBar bar, double crank, double coupler, double rocker)
    {
        MechanismState state = bar.Mechanism.NewState();
        DriveResult result = new PositionSolver(bar.Mechanism).Drive(state, bar.Drive, crank - bar.CrankStart);
        (double gotCoupler, double gotRocker) = bar.AnglesOf(state);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(result.Converged, Is.True);
            Assert.That(FourBar.Wrap(gotCoupler - coupler), Is.EqualTo(0).Within(1e-9));
            Assert.That(FourBar.Wrap(gotRocker - rocker), Is.EqualTo(0).Within(1e-9));
            Assert.That(state.Coordinate(bar.Drive), Is.EqualTo(crank - bar.CrankStart).Within(1e-9));
        }
    }
}
