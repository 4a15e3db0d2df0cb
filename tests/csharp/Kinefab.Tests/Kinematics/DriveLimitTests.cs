using System;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>Drives that end at limits and dead points: where, why and in which sense.</summary>
public class DriveLimitTests
{
    [TestCase(90, 80, true)]
    [TestCase(-45, -10, false)]
    public void Drive_PastAHingesOwnLimit_StopsThere(double target, double expected, bool isUpper)
    {
        var scene = new MechanismScene();
        JointPlace hinge = scene.Hinge(scene.Body("lid", Vector3d.UnitX), null, Vector3d.Zero, new Vector3d(0.2, 1, -0.3), -10, 80);
        AssertStops(scene, hinge, Coordinate.Angle, target, hinge, Coordinate.Angle, expected, isUpper);
    }

    // Unity limits the connected body's twist, so the own body reaches from -high to -low.
    [TestCase(90, 10, true, false)]
    [TestCase(-95, -80, false, false)]
    [TestCase(95, 80, true, true)]
    [TestCase(-40, -10, false, true)]
    public void Drive_PastAConfigurablesTwistLimit_StopsInUnitysSense(double target, double expected, bool isUpper, bool swap)
    {
        var scene = new MechanismScene();
        JointPlace joint = scene.Configurable(
            scene.Body("arm", Vector3d.UnitX), null, new Vector3d(0.1, 0.2, 0), new Vector3d(0, 0.3, 1), Vector3d.UnitX, "LLLMLL", low: -10, high: 80, swap: swap);
        AssertStops(scene, joint, Coordinate.AngularX, target, joint, Coordinate.AngularX, expected, isUpper);
    }

    // The range [-0.02, 0.08] about the exported pose: the connected anchor stands 0.03 along, the radius is 0.05.
    [TestCase(0.2, 0.08, true)]
    [TestCase(-0.2, -0.02, false)]
    public void Drive_PastASlidesAsymmetricRange_StopsAtItsEnds(double target, double expected, bool isUpper)
    {
        var scene = new MechanismScene();
        JointPlace joint = scene.Configurable(
            scene.Body("slider", Vector3d.UnitX), null, new Vector3d(0.1, 0.2, 0), new Vector3d(1, 0.3, 0), Vector3d.UnitZ, "MLLLLL", linearLimit: 0.05, shift: 0.03);
        AssertStops(scene, joint, Coordinate.X, target, joint, Coordinate.X, expected, isUpper);
    }

    [Test]
    public void Drive_AgainstAnotherJointsLimit_StopsAndNamesIt()
    {
        // x = 0.5 cos q + sqrt(2.25 - 0.25 sin^2 q); with x let to rise by 0.1 from q = 60 degrees.
        (MechanismScene scene, JointPlace crank, _, int slider) = PlanarMechanisms.SliderCrank(0.5, 1.5, 0, 60);
        JointPlace stop = scene.Configurable(slider, null, Vector3d.UnitX, Vector3d.UnitX, Vector3d.UnitY, "MFFFFF", linearLimit: 0.1);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        DriveResult result = new PositionSolver(mechanism).Drive(state, crank.Angle(mechanism), -60);
        double x = 1.6861406616378 + 0.1;
        double q = Math.Acos((x * x + 0.25 - 2.25) / (2 * 0.5 * x)) * 180 / Math.PI;
        using (Assert.EnterMultipleScope())
        {
            Assert.That(result.Status, Is.EqualTo(DriveStatus.StoppedByLimit));
            Assert.That(result.Limit?.GameObject, Is.EqualTo(stop.GameObject));
            Assert.That(result.Limit?.Component, Is.EqualTo(stop.Component));
            Assert.That(state.Coordinate(crank.Angle(mechanism)), Is.EqualTo(q - 60).Within(1e-8));
        }
    }

    [Test]
    public void Drive_PastADeadPoint_StopsOutOfReachOnAClosedPose()
    {
        var bar = new FourBar(0.7, 0.9, 0.8, 1.5, 40);
        MechanismState state = bar.Mechanism.NewState();
        DriveResult result = new PositionSolver(bar.Mechanism).Drive(state, bar.Drive, 80);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(result.Status, Is.EqualTo(DriveStatus.OutOfReach));
            Assert.That(state.Coordinate(bar.Drive), Is.EqualTo(94.0960437582 - 40).Within(1e-3));
            Assert.That(result.ErrorMetres, Is.LessThan(1e-10));
        }
    }

    [Test]
    public void Drive_WithALimitThatOtherFreedomsDodge_ReachesTheTarget()
    {
        // Least change alone would turn the right crank by more than its second, limited hinge lets it.
        (MechanismScene scene, JointPlace left, JointPlace right, _, _) = PlanarMechanisms.FiveBar(80, 110);
        JointPlace limited = scene.Hinge(3, null, PlanarMechanisms.At(1.2, 0), Vector3d.UnitZ, -3, 3, closure: true);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        DriveResult result = new PositionSolver(mechanism).Drive(state, left.Angle(mechanism), 40);
        Assert.That(result.Converged, Is.True, $"{result.Status} {result.Fraction}");
        Assert.That(Math.Abs(state.Coordinate(right.Angle(mechanism))), Is.LessThanOrEqualTo(3 + 1e-9));
        Assert.That(result.Limit?.Component, Is.EqualTo(limited.Component), "it rests against the limit");
    }

    private static void AssertStops(
        MechanismScene scene, JointPlace drive, Coordinate driven, double target, JointPlace limited, Coordinate limitedCoordinate, double expected, bool isUpper)
    {
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        var solver = new PositionSolver(mechanism);
        DriveResult result = solver.Drive(state, drive.In(mechanism, driven), target);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(result.Status, Is.EqualTo(DriveStatus.StoppedByLimit));
            Assert.That(state.Coordinate(drive.In(mechanism, driven)), Is.EqualTo(expected).Within(1e-9));
            Assert.That(result.Limit?.GameObject, Is.EqualTo(limited.GameObject));
            Assert.That(result.Limit?.Coordinate, Is.EqualTo(limitedCoordinate));
            Assert.That(result.Limit?.IsUpper, Is.EqualTo(isUpper));
        }

        DriveResult further = solver.Drive(state, drive.In(mechanism, driven), target);
        Assert.That(further.Status, Is.EqualTo(DriveStatus.StoppedByLimit), "from the limit outwards");
        DriveResult back = solver.Drive(state, drive.In(mechanism, driven), 0);
        Assert.That(back.Converged, Is.True, "from the limit back");
        Assert.That(state.Coordinate(drive.In(mechanism, driven)), Is.EqualTo(0).Within(1e-9));
    }
}
