using System;
using System.Linq;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>Gear, rack, screw and planetary couplings over many turns.</summary>
public class CouplingTests
{
    private const double Tolerance = 1e-9;

    [TestCase(100)]
    [TestCase(3600)]
    [TestCase(-3700.5)]
    public void GearPair_Driven_TurnsByTheRatio(double angle)
    {
        var scene = new MechanismScene();
        JointPlace first = scene.Hinge(scene.Body("g1", Vector3d.Zero), null, Vector3d.Zero, Vector3d.UnitZ);
        JointPlace second = scene.Hinge(scene.Body("g2", Vector3d.UnitX), null, Vector3d.UnitX, Vector3d.UnitZ);
        scene.Couple(first, Coordinate.Angle, second, Coordinate.Angle, -20.0 / 50);
        Assert.That(Driven(scene, first, angle, second, Coordinate.Angle), Is.EqualTo(angle * -0.4).Within(Tolerance));
    }

    /// <summary>
    /// A ball whose angle about X is a ratio times the one about Y goes along q ~ (tan(ratio a / 2), tan(a / 2), 0, 1): over poles of either angle, where it has no value
    /// and the other one has.
    /// </summary>
    [TestCase(2, Coordinate.AngularY, 720)]
    [TestCase(2, Coordinate.AngularY, -300)]
    [TestCase(0.5, Coordinate.AngularX, 700)]
    [TestCase(-1.7, Coordinate.AngularY, 500)]
    [TestCase(0.7, Coordinate.AngularX, 330)]
    public void BallOfTwoCoupledAngles_Driven_SwingsOverThePoles(double ratio, Coordinate driven, double to)
    {
        var scene = new MechanismScene();
        JointPlace ball = scene.Configurable(scene.Body("ball", Vector3d.Zero), null, Vector3d.Zero, Vector3d.UnitX, Vector3d.UnitY, "LLLFFF");
        scene.Couple(ball, Coordinate.AngularY, ball, Coordinate.AngularX, ratio);
        Mechanism mechanism = scene.Mechanism();
        int coordinate = ball.In(mechanism, driven);
        SweepResult sweep = new Sweep(new PositionSolver(mechanism)).Run(mechanism.NewState(), coordinate, 0, to, 72);
        Assert.That(sweep.Stop, Is.Null, $"{sweep.Stop}");
        Assert.That(sweep.Jumps, Is.Empty);
        Quaterniond start = sweep.States[0].Pose(0).Rotation;
        for (int i = 0; i <= 72; i++)
        {
            double value = to * i / 72, y = (driven == Coordinate.AngularY ? value : value / ratio) * Math.PI / 180, x = ratio * y;
            var turn = new Quaterniond(Math.Sin(x / 2) * Math.Cos(y / 2), Math.Sin(y / 2) * Math.Cos(x / 2), 0, Math.Cos(x / 2) * Math.Cos(y / 2));
            Assert.That(sweep.Values[i], Is.EqualTo(value).Within(1e-7), $"{value}");

            // Beside its way nothing holds it: there it drifts by what rounding makes of many steps.
            Assert.That(2 * ((turn.Normalized() * start).Conjugate() * sweep.States[i].Pose(0).Rotation).Vector.Length, Is.LessThan(1e-6), $"{value}");
        }
    }

    [Test]
    public void Rack_PinionDrivenTenTurns_TravelsByTheRadius()
    {
        var scene = new MechanismScene();
        JointPlace pinion = scene.Hinge(scene.Body("pinion", Vector3d.Zero), null, Vector3d.Zero, Vector3d.UnitZ);
        JointPlace rack = scene.Slide(scene.Body("rack", Vector3d.UnitY), null, Vector3d.UnitY, Vector3d.UnitX);
        scene.Couple(pinion, Coordinate.Angle, rack, Coordinate.X, 0.25 * Math.PI / 180);
        Assert.That(Driven(scene, pinion, 3600, rack, Coordinate.X), Is.EqualTo(5 * Math.PI).Within(Tolerance));
    }

    // A belt keeps the sense, a linear coupler joins two slides.
    [TestCase(3600)]
    [TestCase(-3600)]
    public void BeltAndLinearCoupler_DrivenTenTurns_KeepTheirRatios(double angle)
    {
        var scene = new MechanismScene();
        JointPlace first = scene.Hinge(scene.Body("pulley1", Vector3d.Zero), null, Vector3d.Zero, Vector3d.UnitZ);
        JointPlace second = scene.Hinge(scene.Body("pulley2", Vector3d.UnitX), null, Vector3d.UnitX, Vector3d.UnitZ);
        JointPlace carriage = scene.Slide(scene.Body("carriage", Vector3d.UnitY), null, Vector3d.UnitY, Vector3d.UnitX);
        JointPlace counterweight = scene.Slide(scene.Body("counterweight", 2 * Vector3d.UnitY), null, 2 * Vector3d.UnitY, new Vector3d(1, 2, 3));
        scene.Couple(first, Coordinate.Angle, second, Coordinate.Angle, 1.5);
        scene.Couple(second, Coordinate.Angle, carriage, Coordinate.X, 0.1 * Math.PI / 180);
        scene.Couple(carriage, Coordinate.X, counterweight, Coordinate.X, -0.5);
        Assert.That(Driven(scene, first, angle, second, Coordinate.Angle), Is.EqualTo(1.5 * angle).Within(Tolerance));
        Assert.That(Driven(scene, first, angle, counterweight, Coordinate.X), Is.EqualTo(-0.075 * angle * Math.PI / 180).Within(Tolerance));
    }

    // A slide follows the turns of two wheels and the travel of another slide.
    [TestCase(3600, -0.25)]
    [TestCase(-700.5, 0.5)]
    public void SumOfThree_AllDriven_IsFollowed(double angle, double travel)
    {
        var scene = new MechanismScene();
        JointPlace first = scene.Hinge(scene.Body("first", Vector3d.Zero), null, Vector3d.Zero, Vector3d.UnitZ);
        JointPlace second = scene.Hinge(scene.Body("second", Vector3d.UnitX), null, Vector3d.UnitX, new Vector3d(1, -2, 3));
        JointPlace slide = scene.Slide(scene.Body("slide", Vector3d.UnitY), null, Vector3d.UnitY, Vector3d.UnitX);
        JointPlace sum = scene.Slide(scene.Body("sum", 2 * Vector3d.UnitY), null, 2 * Vector3d.UnitY, new Vector3d(1, 2, 3));
        scene.Couple(sum, Coordinate.X, 0.125, (first, Coordinate.Angle, 0.001), (second, Coordinate.Angle, -0.002), (slide, Coordinate.X, 0.5));
        Mechanism mechanism = scene.Mechanism();
        var solver = new PositionSolver(mechanism);
        MechanismState state = mechanism.NewState();
        solver.Drive(state, first.Angle(mechanism), angle);
        Assert.That(solver.Drive(state, slide.In(mechanism, Coordinate.X), travel).Converged);

        Assert.That(MobilityAnalysis.Of(mechanism).Mobility, Is.EqualTo(3));
        Assert.That(state.Coordinate(slide.In(mechanism, Coordinate.X)), Is.EqualTo(travel).Within(Tolerance));
        double expected = 0.001 * state.Coordinate(first.Angle(mechanism)) - 0.002 * state.Coordinate(second.Angle(mechanism)) + 0.5 * travel + 0.125;
        Assert.That(state.Coordinate(sum.In(mechanism, Coordinate.X)), Is.EqualTo(expected).Within(Tolerance));
    }

    [Test]
    public void ScrewJack_ScrewDrivenTwoTurns_LowersTheNutByTwoLeads()
    {
        var scene = new MechanismScene();
        int screw = scene.Body("screw", Vector3d.Zero);
        int nut = scene.Body("nut", Vector3d.UnitZ);
        JointPlace drive = scene.Hinge(screw, null, Vector3d.Zero, Vector3d.UnitZ);
        JointPlace thread = scene.Configurable(nut, screw, Vector3d.UnitZ, Vector3d.UnitZ, Vector3d.UnitX, "FLLFLL");
        JointPlace slide = scene.Slide(nut, null, Vector3d.UnitZ, Vector3d.UnitZ);
        scene.Couple(thread, Coordinate.AngularX, thread, Coordinate.X, 0.05 / 360);
        Assert.That(Driven(scene, drive, 720, slide, Coordinate.X), Is.EqualTo(-0.1).Within(Tolerance));
    }

    [Test]
    public void Planetary_SunDriven_TurnsCarrierAndPlanetByTheTeeth()
    {
        var scene = new MechanismScene();
        int carrier = scene.Body("carrier", Vector3d.Zero);
        int planet = scene.Body("planet", Vector3d.UnitX);
        JointPlace sun = scene.Hinge(scene.Body("sun", Vector3d.Zero), null, Vector3d.Zero, Vector3d.UnitZ);
        JointPlace arm = scene.Hinge(carrier, null, Vector3d.Zero, Vector3d.UnitZ);
        JointPlace spin = scene.Hinge(planet, carrier, Vector3d.UnitX, Vector3d.UnitZ);
        scene.Couple(sun, Coordinate.Angle, arm, Coordinate.Angle, 24.0 / 84);
        scene.Couple(arm, Coordinate.Angle, spin, Coordinate.Angle, -60.0 / 18);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        new PositionSolver(mechanism).Drive(state, sun.Angle(mechanism), 210);
        Assert.That(state.Coordinate(arm.Angle(mechanism)), Is.EqualTo(60).Within(Tolerance));
        Assert.That(scene.TurnAboutZ(state, planet), Is.EqualTo(-140).Within(Tolerance));
    }

    [Test]
    public void Coupling_WithOffset_ClosesToTheOffset()
    {
        var scene = new MechanismScene();
        JointPlace first = scene.Hinge(scene.Body("a", Vector3d.Zero), null, Vector3d.Zero, Vector3d.UnitZ);
        JointPlace second = scene.Hinge(scene.Body("b", Vector3d.UnitX), null, Vector3d.UnitX, Vector3d.UnitZ);
        scene.Couple(first, Coordinate.Angle, second, Coordinate.Angle, 3, 12);
        Assert.That(Driven(scene, first, 20, second, Coordinate.Angle), Is.EqualTo(72).Within(Tolerance));
    }

    [Test]
    public void LockedCoordinate_OfTwoCouplings_StandsThereOnceAndHoldsBoth()
    {
        var scene = new MechanismScene();
        JointPlace first = scene.Hinge(scene.Body("a", Vector3d.Zero), null, Vector3d.Zero, Vector3d.UnitZ);
        JointPlace second = scene.Hinge(scene.Body("b", Vector3d.UnitX), null, Vector3d.UnitX, Vector3d.UnitZ);
        JointPlace slide = scene.Slide(scene.Body("c", Vector3d.UnitY), null, Vector3d.UnitY, Vector3d.UnitX);
        scene.Couple(first, Coordinate.Angle, slide, Coordinate.AngularX, 2);
        scene.Couple(slide, Coordinate.AngularX, second, Coordinate.Angle, 2);

        Mechanism mechanism = scene.Mechanism();

        Assert.That(string.Join(" ", mechanism.Coordinates.Select(c => c.Name)), Is.EqualTo("a.angle b.angle c.x c.angularX"));
        Assert.That(MobilityAnalysis.Of(mechanism).Mobility, Is.EqualTo(1), "the slide alone moves");
    }

    private static double Driven(MechanismScene scene, JointPlace drive, double value, JointPlace read, Coordinate reading)
    {
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        DriveResult result = new PositionSolver(mechanism).Drive(state, drive.Angle(mechanism), value);
        Assert.That(result.Converged, Is.True, result.Status.ToString());
        return state.Coordinate(read.In(mechanism, reading));
    }
}
