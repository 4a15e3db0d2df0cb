using Kinefab.Kinematics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>Motions through poses where branches cross stay on their branch.</summary>
public class BranchTests
{
    [TestCase(300)]
    [TestCase(120)]
    [TestCase(-180)]
    public void Drive_ParallelogramThroughItsFlatPoses_StaysAParallelogram(double target)
    {
        foreach (double step in new[] { 400.0, 7, 30, 60 })
        {
            var bar = new FourBar(0.5, 1, 0.5, 1, 60);
            MechanismState state = bar.Mechanism.NewState();
            var solver = new PositionSolver(bar.Mechanism);
            double at = 0;
            while (at != target)
            {
                at = target > at ? System.Math.Min(target, at + step) : System.Math.Max(target, at - step);
                DriveResult result = solver.Drive(state, bar.Drive, at);
                Assert.That(result.Converged, Is.True, $"at {at} by {step}");
                // The flat pose is a double root: errors of 1e-13, Newton's stop, leave 3e-7 radians open there.
                double tolerance = (at + 60) % 180 == 0 ? 2e-5 : 1e-9;
                Assert.That(bar.AnglesOf(state).Coupler, Is.EqualTo(0).Within(tolerance), $"at {at} by {step}");
            }
        }
    }

    [Test]
    public void Drive_LadderOfParallelograms_PassesItsFlatPose()
    {
        (MechanismScene scene, JointPlace first) = PlanarMechanisms.Ladder(5, 90);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        DriveResult result = new PositionSolver(mechanism).Drive(state, first.Angle(mechanism), 180);
        Assert.That(result.Converged, Is.True);
        Vector3d x = scene.Turn(state, 10) * Vector3d.UnitX;
        Assert.That((x - Vector3d.UnitX).Length, Is.LessThan(1e-7), "the bars over the uprights keep level");
    }

    // Change point with unequal links: a + b = c + d, all other Grashof sums smaller; the kite folds at 180 degrees.
    [Test]
    public void Drive_ChangePointLinkage_KeepsTheBranchOfItsClosedForm()
    {
        var bar = new FourBar(0.4, 1.1, 0.7, 1, 60);
        MechanismState state = bar.Mechanism.NewState();
        var solver = new PositionSolver(bar.Mechanism);
        for (double crank = 60; crank <= 175; crank += 5)
        {
            Assert.That(solver.Drive(state, bar.Drive, crank - 60).Converged, Is.True);
            Assert.That(FourBar.Wrap(bar.AnglesOf(state).Rocker - bar.Angles(crank).Rocker), Is.EqualTo(0).Within(1e-8));
        }
    }
}
