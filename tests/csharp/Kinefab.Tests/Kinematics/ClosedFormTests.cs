using System;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>Positions of driven mechanisms against their closed forms; the formula stands beside each case.</summary>
public class ClosedFormTests
{
    private const double Radians = Math.PI / 180;
    private const double Tolerance = 1e-9;

    // x = r cos q + sqrt(l^2 - (r sin q - e)^2)
    [TestCase(0, 60, 1.6861406616)]
    [TestCase(0, 90, 1.4142135624)]
    [TestCase(0, 200, 1.0203736584)]
    [TestCase(0.2, 0, 1.9866068747)]
    [TestCase(0.2, 60, 1.7317911731)]
    [TestCase(0.2, 200, 0.9835467977)]
    public void SliderCrank_Driven_MeetsClosedForm(double offset, double crank, double expected)
    {
        foreach (bool minimal in new[] { false, true })
        {
            (MechanismScene scene, JointPlace drive, JointPlace slide, _) = PlanarMechanisms.SliderCrank(0.5, 1.5, offset, 35, minimal);
            Mechanism mechanism = scene.Mechanism();
            double start = 0.5 * Math.Cos(35 * Radians) + Math.Sqrt(2.25 - Math.Pow(0.5 * Math.Sin(35 * Radians) - offset, 2));
            double x = start + Driven(mechanism, drive, Coordinate.Angle, crank - 35, slide, Coordinate.X);
            Assert.That(x, Is.EqualTo(expected).Within(Tolerance));
        }
    }

    // x_D = r cos q + sqrt(l^2 - r^2 sin^2 q), r = 0.25, l = 0.9
    [TestCase(0, 1.15)]
    [TestCase(90, 0.8645808233)]
    [TestCase(135, 0.7056914344)]
    [TestCase(180, 0.65)]
    public void PaperLever_Driven_MeetsClosedForm(double lever, double expected)
    {
        foreach (bool withParts in new[] { false, true })
        {
            (MechanismScene scene, JointPlace drive, JointPlace slide) = PlanarMechanisms.PaperLever(30, withParts);
            double x = 1.1077835244 + Driven(scene.Mechanism(), drive, Coordinate.Angle, lever - 30, slide, Coordinate.X);
            Assert.That(x, Is.EqualTo(expected).Within(Tolerance));
        }
    }

    // x = R cos q
    [TestCase(40, 0.2298133329)]
    [TestCase(100, -0.0520944533)]
    [TestCase(250, -0.1026060430)]
    public void ScotchYoke_Driven_MeetsClosedForm(double crank, double expected)
    {
        (MechanismScene scene, JointPlace drive, JointPlace slide) = PlanarMechanisms.ScotchYoke(20);
        double x = 0.3 * Math.Cos(20 * Radians) + Driven(scene.Mechanism(), drive, Coordinate.Angle, crank - 20, slide, Coordinate.X);
        Assert.That(x, Is.EqualTo(expected).Within(Tolerance));
    }

    // centre = e cos q (cos q, sin q), out angle = in angle
    [TestCase(25)]
    [TestCase(70)]
    [TestCase(160)]
    public void Oldham_Driven_MovesTheDiscOnItsCircle(double input)
    {
        (MechanismScene scene, JointPlace drive, int disc, JointPlace driven, Vector3d centre) = PlanarMechanisms.Oldham(10);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        new PositionSolver(mechanism).Drive(state, drive.Angle(mechanism), input - 10);
        Vector3d expected = PlanarMechanisms.Polar(0.2 * Math.Cos(input * Radians), input);
        Vector3d got = state.Pose(disc).Point(scene.Local(disc, centre));
        Assert.That((got - expected).Length, Is.LessThan(Tolerance));
        Assert.That(state.Coordinate(driven.Angle(mechanism)), Is.EqualTo(input - 10).Within(Tolerance));
    }

    // h = L sin q
    [TestCase(35)]
    [TestCase(60)]
    public void Scissor_Driven_MeetsClosedForm(double arm)
    {
        (MechanismScene scene, JointPlace drive, int platform) = PlanarMechanisms.Scissor(20);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        new PositionSolver(mechanism).Drive(state, drive.Angle(mechanism), arm - 20);
        double height = state.Pose(platform).Point(scene.Local(platform, Vector3d.Zero)).Y + Math.Sin(20 * Radians);
        Assert.That(height, Is.EqualTo(Math.Sin(arm * Radians)).Within(Tolerance));
    }

    // dy = -dx tan 20
    [Test]
    public void Wedge_Driven_MeetsClosedForm()
    {
        (MechanismScene scene, JointPlace drive, JointPlace follower) = PlanarMechanisms.Wedge();
        double y = Driven(scene.Mechanism(), drive, Coordinate.X, 0.3, follower, Coordinate.X);
        Assert.That(y, Is.EqualTo(-0.1091910703).Within(Tolerance));
    }

    // h = 2 l sin phi
    [TestCase(30, 1)]
    [TestCase(50, 1.5320888862)]
    [TestCase(75, 1.9318516526)]
    public void Sarrus_Driven_LiftsThePlatformStraight(double phi, double expected)
    {
        (MechanismScene scene, JointPlace drive, int platform) = SpatialMechanisms.Sarrus(40);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        DriveResult result = new PositionSolver(mechanism).Drive(state, drive.Angle(mechanism), phi - 40);
        Vector3d top = state.Pose(platform).Point(scene.Local(platform, Vector3d.Zero));
        Assert.That(result.Converged, Is.True);
        Assert.That((top - new Vector3d(0, 0, expected - 2 * Math.Sin(40 * Radians))).Length, Is.LessThan(Tolerance));
    }

    // tan(t1/2) tan(t2/2) = sin((b+a)/2) / sin((b-a)/2)
    [TestCase(40, 161.5398005402)]
    [TestCase(80, 138.9243319005)]
    [TestCase(130, 92.4893427037)]
    public void Bennett_Driven_MeetsClosedForm(double theta1, double theta2)
    {
        (MechanismScene scene, JointPlace first, JointPlace second) = SpatialMechanisms.Bennett(60);
        double start = 2 * Math.Atan(2.2397641136 / Math.Tan(30 * Radians)) / Radians;
        double got = start + Driven(scene.Mechanism(), first, Coordinate.Angle, theta1 - 60, second, Coordinate.Angle);
        Assert.That(got, Is.EqualTo(theta2).Within(3e-8), "K is known to 11 digits here");
    }

    // P3 = (cos q / (1 + sin q), -cos q2, -sin q / (1 + sin q)), sin q2 = -sin q / (1 + sin q)
    [TestCase(30, 0.5773502692, -0.9428090416, -0.3333333333)]
    [TestCase(90, 0, -0.8660254038, -0.5)]
    [TestCase(150, -0.5773502692, -0.9428090416, -0.3333333333)]
    public void Bricard_Driven_MeetsClosedForm(double q, double x, double y, double z)
    {
        (MechanismScene scene, JointPlace drive, int second, Vector3d p3) = SpatialMechanisms.Bricard();
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        DriveResult result = new PositionSolver(mechanism).Drive(state, drive.Angle(mechanism), q);
        Assert.That(result.Converged, Is.True);
        Assert.That((state.Pose(second).Point(scene.Local(second, p3)) - new Vector3d(x, y, z)).Length, Is.LessThan(Tolerance));
    }

    // tan(out) = tan(in) cos(30)
    [TestCase(30, 26.5650511771)]
    [TestCase(60, 56.3099324740)]
    [TestCase(135, 139.1066053509)]
    [TestCase(720, 720)]
    public void Cardan_Driven_MeetsClosedForm(double input, double output)
    {
        foreach (bool minimal in new[] { false, true })
        {
            (MechanismScene scene, JointPlace drive, JointPlace driven) = SpatialMechanisms.Cardan(minimal);
            Coordinate reading = minimal ? Coordinate.AngularX : Coordinate.Angle;
            double got = Driven(scene.Mechanism(), drive, Coordinate.Angle, input, driven, reading);
            Assert.That(got, Is.EqualTo(output).Within(Tolerance), minimal ? "universal" : "four hinges");
        }
    }

    [Test]
    public void Stewart_SixLegsDriven_BringThePlatformToThePose()
    {
        double[] lengths = [1.3510188083, 1.5086279002, 1.4698209846, 1.4577416667, 1.2801880988, 1.4847198279];
        (MechanismScene scene, int platform, JointPlace[] legs) = SpatialMechanisms.Stewart(withUniversals: true);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        var targets = new CoordinateTarget[6];
        for (int k = 0; k < 6; k++)
        {
            targets[k] = new CoordinateTarget(legs[k].In(mechanism, Coordinate.X), lengths[k] - 1.3714031749);
        }

        DriveResult result = new PositionSolver(mechanism).Drive(state, targets);
        Quaterniond rotation = Quaterniond.AxisAngle(Vector3d.UnitZ, 12 * Radians)
            * Quaterniond.AxisAngle(Vector3d.UnitY, -7 * Radians)
            * Quaterniond.AxisAngle(Vector3d.UnitX, 5 * Radians);
        Vector3d centre = state.Pose(platform).Point(scene.Local(platform, new Vector3d(0, 0, 1.2)));
        Assert.That(result.Converged, Is.True);
        Assert.That((centre - new Vector3d(0.08, -0.05, 1.25)).Length, Is.LessThan(Tolerance));
        Quaterniond difference = scene.Turn(state, platform) * rotation.Conjugate();
        Assert.That(2 * difference.Vector.Length, Is.LessThan(Tolerance));
    }

    [Test]
    public void Delta_ThreeArmsDriven_BringThePlatformToThePlace()
    {
        (MechanismScene scene, int platform, JointPlace[] arms) = SpatialMechanisms.Delta(withBalls: false);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        // Arm angles are below the horizontal, turning about the tangent lowers the elbow.
        double[] below = [10, 25, 40];
        var targets = new CoordinateTarget[3];
        for (int k = 0; k < 3; k++)
        {
            targets[k] = new CoordinateTarget(arms[k].Angle(mechanism), below[k] - 30);
        }

        DriveResult result = new PositionSolver(mechanism).Drive(state, targets);
        Vector3d moved = state.Pose(platform).Point(scene.Local(platform, new Vector3d(0, 0, -0.3356660259)));
        Assert.That(result.Converged, Is.True);
        Assert.That((moved - new Vector3d(0.0527531548, 0.0333407730, -0.3036716603)).Length, Is.LessThan(2e-9));
    }

    private static double Driven(Mechanism mechanism, JointPlace drive, Coordinate driven, double value, JointPlace read, Coordinate reading)
    {
        MechanismState state = mechanism.NewState();
        DriveResult result = new PositionSolver(mechanism).Drive(state, drive.In(mechanism, driven), value);
        Assert.That(result.Converged, Is.True, $"{result.Status} at {result.Fraction}");
        Assert.That(result.ErrorMetres, Is.LessThan(1e-11));
        Assert.That(result.ErrorDegrees, Is.LessThan(1e-9));
        return state.Coordinate(read.In(mechanism, reading));
    }
}
