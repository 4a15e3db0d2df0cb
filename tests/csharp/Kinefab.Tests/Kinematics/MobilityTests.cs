using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>
/// Mobility of mechanisms whose counts are known: rows, velocities at the pose, finite motions. The numbers come from
/// Gruebler's count and the literature on each linkage, not from this library.
/// </summary>
public class MobilityTests
{
    // Rows, first order, finite.
    private static IEnumerable<TestCaseData> Mechanisms()
    {
        yield return Case("crank-rocker", () => new FourBar(0.4, 1.2, 0.8, 1, 25).Mechanism, 20, 1, 1);
        yield return Case("parallelogram", () => new FourBar(0.5, 1, 0.5, 1, 60).Mechanism, 20, 1, 1);
        yield return Case("flat parallelogram", () => Flat().Mechanism, 20, 2, 1);
        yield return Case("parallelogram with a middle bar", MiddleBar, 30, 1, 1);
        yield return Case("slider-crank", () => PlanarMechanisms.SliderCrank(0.5, 1.5, 0.2, 35).Scene.Mechanism(), 20, 1, 1);
        yield return Case("slider-crank, minimal closure", () => PlanarMechanisms.SliderCrank(0.5, 1.5, 0.2, 35, true).Scene.Mechanism(), 17, 1, 1);
        yield return Case("paper lever", () => PlanarMechanisms.PaperLever(30, true).Scene.Mechanism(), 29, 1, 1);
        yield return Case("scotch yoke", () => PlanarMechanisms.ScotchYoke(20).Scene.Mechanism(), 14, 1, 1);
        yield return Case("Sarrus", () => SpatialMechanisms.Sarrus(40).Scene.Mechanism(), 30, 1, 1);
        yield return Case("Bennett", () => SpatialMechanisms.Bennett(60).Scene.Mechanism(), 20, 1, 1);
        yield return Case("Bricard", () => SpatialMechanisms.Bricard().Scene.Mechanism(), 30, 1, 1);
        yield return Case("Stewart 6-UPS", () => SpatialMechanisms.Stewart(true).Scene.Mechanism(), 72, 6, 6);
        yield return Case("Stewart 6-SPS", () => SpatialMechanisms.Stewart(false).Scene.Mechanism(), 66, 12, 12);
        yield return Case("hexapod of rods", () => Hexapod(0), 42, 0, 0);
        yield return Case("similar hexagons at 90 degrees", () => Hexapod(90), 42, 3, 1);
        yield return Case("Delta of rods", () => SpatialMechanisms.Delta(false).Scene.Mechanism(), 57, 3, 3);
        yield return Case("Delta of ball rods", () => SpatialMechanisms.Delta(true).Scene.Mechanism(), 51, 9, 9);
        yield return Case("Cardan of hinges", () => SpatialMechanisms.Cardan(false).Scene.Mechanism(), 20, 1, 1);
        yield return Case("Cardan of a universal", () => SpatialMechanisms.Cardan(true).Scene.Mechanism(), 11, 1, 1);
        yield return Case("Oldham", () => PlanarMechanisms.Oldham(10).Scene.Mechanism(), 20, 1, 1);
        yield return Case("RCCC", () => SpatialMechanisms.Rccc().Mechanism(), 17, 1, 1);
        yield return Case("wedge", () => PlanarMechanisms.Wedge().Scene.Mechanism(), 15, 1, 1);
        yield return Case("scissor", () => PlanarMechanisms.Scissor(20).Scene.Mechanism(), 23, 1, 1);
        yield return Case("five-bar", () => PlanarMechanisms.FiveBar(80, 110).Scene.Mechanism(), 25, 2, 2);
        yield return Case("truss", Truss, 15, 0, 0);
        yield return Case("3-RPS", () => SpatialMechanisms.Rps().Mechanism(), 39, 3, 3);
        yield return Case("6R arm", () => SpatialMechanisms.Arm().Scene.Mechanism(), 30, 6, 6);
        yield return Case("ladder of 2", () => PlanarMechanisms.Ladder(2, 90).Scene.Mechanism(), 35, 1, 1);
        yield return Case("flat ladder of 2", () => PlanarMechanisms.Ladder(2, 0).Scene.Mechanism(), 35, 3, 1);
        yield return Case("flat ladder of 40", () => PlanarMechanisms.Ladder(40, 0).Scene.Mechanism(), 605, 41, 1); // counted 2, its velocities tried one by one
        yield return Case("ladder of 40", () => PlanarMechanisms.Ladder(40, 90).Scene.Mechanism(), 605, 1, 1);
        yield return Case("toggle", () => Toggle().Mechanism, 20, 1, 1);
    }

    [TestCaseSource(nameof(Mechanisms))]
    public void Mobility_KnownMechanism_IsCountedRight(Func<Mechanism> make, int rows, int firstOrder, int finite)
    {
        Mechanism mechanism = make();
        MobilityReport report = MobilityAnalysis.Of(mechanism);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(report.Rows, Is.EqualTo(rows), "rows");
            Assert.That(report.FirstOrder, Is.EqualTo(firstOrder), "first order");
            Assert.That(report.Mobility, Is.EqualTo(finite), "finite");
            Assert.That(report.Redundant, Is.EqualTo(rows - 6 * report.Bodies.Count + firstOrder), "redundant");
            Assert.That(report.Joints.Sum(j => j.Redundant), Is.EqualTo(report.Redundant), "redundant rows by joint");
            Assert.That(report.Islands.Sum(i => i.Mobility), Is.EqualTo(finite), "islands");
        }
    }

    [Test]
    public void Mobility_Arm_CountsEachLinksFreedoms()
    {
        MobilityReport report = MobilityAnalysis.Of(SpatialMechanisms.Arm().Scene.Mechanism());
        Assert.That(string.Join(" ", report.Bodies.Select(b => b.Translations + b.Rotations)), Is.EqualTo("1 2 3 4 5 6"));
        Assert.That(report.Bodies[0].Rotations, Is.EqualTo(1));
        Assert.That(report.Bodies[0].Translations, Is.Zero);
    }

    [Test]
    public void Mobility_Toggle_LocksTheCrankAtFirstOrder()
    {
        MobilityReport report = MobilityAnalysis.Of(Toggle().Mechanism);
        Assert.That(string.Join(" ", report.Bodies.Select(b => b.Translations + b.Rotations)), Is.EqualTo("0 1 1"));
    }

    [Test]
    public void Mobility_PlanarLoop_NamesTheClosingHingeAndItsThreeRows()
    {
        RedundantRows redundant = MobilityAnalysis.Of(new FourBar(0.4, 1.2, 0.8, 1, 25).Mechanism).Joints.Single();
        Assert.That((redundant.GameObject, redundant.Component, redundant.Rows, redundant.Redundant), Is.EqualTo((1, 2, 5, 3)));
    }

    // What a minimal closure leaves where the rest of the loop holds everything: it keeps two parts from colliding.
    [Test]
    public void Mobility_FreeJointBetweenTwoParts_IsALoopWithoutRows()
    {
        var scene = new MechanismScene();
        int a = scene.Body("a", Vector3d.Zero);
        int b = scene.Body("b", Vector3d.UnitZ);
        scene.Hinge(a, null, Vector3d.Zero, Vector3d.UnitZ);
        scene.Hinge(b, null, Vector3d.UnitZ, Vector3d.UnitZ);
        scene.Configurable(b, a, Vector3d.Zero, Vector3d.UnitZ, Vector3d.UnitX, "FFFFFF", closure: true);
        MobilityReport report = MobilityAnalysis.Of(scene.Mechanism());
        using (Assert.EnterMultipleScope())
        {
            Assert.That((report.Mobility, report.FirstOrder, report.Rows, report.Redundant), Is.EqualTo((2, 2, 10, 0)));
            Assert.That(report.Islands.Select(i => (i.Mobility, i.Redundant, i.Loops)), Is.EqualTo([(2, 0, 1)]));
        }
    }

    [Test]
    public void Mobility_TwoMechanismsAndALooseBody_AreThreeIslands()
    {
        var scene = new MechanismScene();
        scene.Hinge(scene.Body("a", Vector3d.UnitX), null, Vector3d.Zero, Vector3d.UnitZ);
        scene.Body("loose", Vector3d.UnitY);
        int b = scene.Body("b", Vector3d.UnitZ);
        scene.Slide(b, null, Vector3d.UnitZ, Vector3d.UnitX);
        scene.Ball(scene.Body("c", new Vector3d(1, 0, 1)), b, new Vector3d(0.5, 0, 1));
        MobilityReport report = MobilityAnalysis.Of(scene.Mechanism());
        Assert.That(string.Join(" ", report.Islands.Select(i => i.Mobility)), Is.EqualTo("1 6 4"));
        Assert.That(string.Join(" ", report.Islands[2].GameObjects), Is.EqualTo("2 3"));
    }

    [Test]
    public void Mobility_GearsRackScrewAndPlanetary_LoseOneFreedomEach()
    {
        var scene = new MechanismScene();
        JointPlace a = scene.Hinge(scene.Body("a", Vector3d.Zero), null, Vector3d.Zero, Vector3d.UnitZ);
        JointPlace b = scene.Hinge(scene.Body("b", Vector3d.UnitX), null, Vector3d.UnitX, Vector3d.UnitZ);
        JointPlace c = scene.Slide(scene.Body("c", Vector3d.UnitY), null, Vector3d.UnitY, Vector3d.UnitX);
        scene.Couple(a, Coordinate.Angle, b, Coordinate.Angle, -0.4);
        Assert.That(MobilityAnalysis.Of(scene.Mechanism()).Mobility, Is.EqualTo(2));
        scene.Couple(b, Coordinate.Angle, c, Coordinate.X, 0.01);
        MobilityReport report = MobilityAnalysis.Of(scene.Mechanism());
        Assert.That((report.Mobility, report.Rows, report.Redundant, report.Islands.Count), Is.EqualTo((1, 17, 0, 1)));
    }

    [Test]
    public void Mobility_CouplingBetweenBodiesAtRest_HoldsNothing()
    {
        var scene = new MechanismScene();
        JointPlace a = scene.Hinge(scene.Body("a", Vector3d.Zero, isKinematic: true), null, Vector3d.Zero, Vector3d.UnitZ);
        JointPlace b = scene.Hinge(scene.Body("b", Vector3d.UnitX, isKinematic: true), null, Vector3d.UnitX, Vector3d.UnitZ);
        scene.Hinge(scene.Body("c", Vector3d.UnitY), null, Vector3d.UnitY, Vector3d.UnitZ);
        scene.Couple(a, Coordinate.Angle, b, Coordinate.Angle, 2);
        MobilityReport report = MobilityAnalysis.Of(scene.Mechanism());
        Assert.That((report.Mobility, report.Rows, report.Redundant), Is.EqualTo((1, 5, 0)));
    }

    // The second hinge closes no loop: b is fixed to the world. A gear counts from it all the same.
    [Test]
    public void Mobility_CouplingFromAJointThatTheTreeHolds_CountsItsRowsOnce()
    {
        var scene = new MechanismScene();
        int b = scene.Body("b", Vector3d.UnitX);
        scene.Fixed(b, null);
        JointPlace held = scene.Hinge(b, null, Vector3d.UnitX, Vector3d.UnitZ);
        JointPlace free = scene.Hinge(scene.Body("c", Vector3d.UnitY), null, Vector3d.UnitY, Vector3d.UnitZ);
        scene.Couple(free, Coordinate.Angle, held, Coordinate.Angle, 2);
        MobilityReport report = MobilityAnalysis.Of(scene.Mechanism());
        Assert.That((report.Mobility, report.Joints.Single().Rows, report.Joints.Single().Redundant), Is.EqualTo((0, 5, 5)));
    }

    // Crank and rocker turn about skew axes; the rod between their balls spins, and moves nothing else.
    [Test]
    public void Mobility_RodOfASingleLoop_SpinsIdly()
    {
        var scene = new MechanismScene();
        int crank = scene.Body("crank", Vector3d.Zero);
        int rod = scene.Body("rod", new Vector3d(0.3, 0.1, 0.2));
        int rocker = scene.Body("rocker", new Vector3d(1, 0, 0.3));
        scene.Hinge(crank, null, Vector3d.Zero, new Vector3d(0.1, 0, 1));
        scene.Ball(rod, crank, new Vector3d(0.3, 0.1, 0.2));
        scene.Ball(rod, rocker, new Vector3d(0.9, 0.7, 0.5));
        scene.Hinge(rocker, null, new Vector3d(1, 0, 0.3), new Vector3d(1, 0.2, 0.1));
        MobilityReport report = MobilityAnalysis.Of(scene.Mechanism());
        Assert.That((report.Mobility, report.Idle.Count), Is.EqualTo((2, 1)));
        Assert.That((report.Idle[0].GameObjects.Single(), report.Idle[0].Count), Is.EqualTo((rod, 1)));
    }

    // A ram between two balls spins as a whole, its two parts by themselves do not; the middle stage slides between the others.
    [Test]
    public void Mobility_RamOfThreeStagesInASingleLoop_SpinsAsOneAndShiftsItsMiddle()
    {
        var scene = new MechanismScene();
        Vector3d foot = new(0.3, -0.2, 0), tip = new(0.8, 0.6, 0), along = (tip - foot) * (1 / (tip - foot).Length);
        int boom = scene.Body("boom", Vector3d.Zero);
        int tube = scene.Body("tube", foot);
        int middle = scene.Body("middle", foot);
        int piston = scene.Body("piston", tip);
        scene.Hinge(boom, null, Vector3d.Zero, Vector3d.UnitZ);
        scene.Ball(tube, null, foot);
        scene.Slide(middle, tube, foot, along);
        scene.Slide(piston, middle, foot, along);
        scene.Ball(piston, boom, tip);
        MobilityReport report = MobilityAnalysis.Of(scene.Mechanism());
        Assert.That(report.Mobility, Is.EqualTo(3));
        Assert.That(report.Idle.Select(i => string.Join(" ", i.GameObjects)), Is.EquivalentTo(new[] { $"{middle}", $"{tube} {middle} {piston}" }));
    }

    // Nothing is grounded: two plates turn against the other two about one axis. What hangs on the first holds it, and what hangs on the third
    // by the same axis holds nothing, whichever of them the count begins with.
    [TestCase("abcd")]
    [TestCase("bcda")]
    [TestCase("cdab")]
    [TestCase("dabc")]
    public void Mobility_FloatingLoop_HasTheSameIdleFreedomsFromEveryRoot(string order)
    {
        var scene = new MechanismScene();
        var plates = order.ToDictionary(name => name, name => scene.Body($"{name}", new Vector3d(0.2 * (name - 'a'), 0.1, 0.3)));
        int held = scene.Body("held", new Vector3d(1, 1, 0));
        scene.Hinge(plates['b'], plates['a'], Vector3d.Zero, Vector3d.UnitZ);
        scene.Ball(plates['c'], plates['b'], new Vector3d(0.5, 0, 0.1));
        scene.Hinge(plates['d'], plates['c'], new Vector3d(0, 0, 0.4), Vector3d.UnitZ);
        scene.Ball(plates['a'], plates['d'], new Vector3d(0.3, 0.6, 0.2));
        scene.Hinge(held, plates['a'], new Vector3d(1, 1, 0), Vector3d.UnitX);
        scene.Hinge(scene.Body("near", Vector3d.UnitX), plates['c'], Vector3d.Zero, Vector3d.UnitZ);
        scene.Hinge(scene.Body("far", -Vector3d.UnitX), plates['c'], Vector3d.Zero, Vector3d.UnitZ);
        MobilityReport report = MobilityAnalysis.Of(scene.Mechanism());
        Assert.That((report.Mobility, report.Idle.Sum(idle => idle.Count)), Is.EqualTo((11, 1)));
    }

    // Three stretched legs hold the platform: each seems to buckle by itself, and none does.
    [Test]
    public void Mobility_ThreeStretchedLegs_HaveNoIdleFreedom()
    {
        var scene = new MechanismScene();
        int platform = scene.Body("platform", Vector3d.Zero);
        for (int k = 0; k < 3; k++)
        {
            Vector3d foot = PlanarMechanisms.Polar(1, 120 * k), knee = foot * 0.65, hip = foot * 0.3;
            int lower = scene.Body($"lower{k}", foot);
            int upper = scene.Body($"upper{k}", knee);
            scene.Hinge(lower, null, foot, Vector3d.UnitZ);
            scene.Hinge(upper, lower, knee, Vector3d.UnitZ);
            scene.Hinge(upper, platform, hip, Vector3d.UnitZ);
        }

        MobilityReport report = MobilityAnalysis.Of(scene.Mechanism());
        Assert.That((report.FirstOrder, report.Mobility, report.Idle.Count), Is.EqualTo((4, 0, 0)));
    }

    // A pin slides in a slot that its hinge can turn out of the way: the slide is a motion, and the turn is obstructed by its fourth power alone.
    [Test]
    public void Mobility_SlideBesideATurnThatIsObstructedLate_IsOneFreedom()
    {
        var scene = new MechanismScene();
        int slotted = scene.Body("slotted", Vector3d.Zero);
        int column = scene.Body("column", new Vector3d(1, 2, 0));
        int arm = scene.Body("arm", new Vector3d(0, 2, 2));
        scene.Hinge(slotted, null, new Vector3d(1, 1, 1), Vector3d.UnitX);
        scene.Configurable(column, null, new Vector3d(1, 2, 0), Vector3d.UnitZ, Vector3d.UnitX, "FLLFLL");
        scene.Hinge(arm, column, new Vector3d(0, 2, 2), Vector3d.UnitZ);
        scene.Configurable(slotted, arm, new Vector3d(1, 0, 1), Vector3d.UnitX, Vector3d.UnitZ, "LFLFLL", closure: true);
        MobilityReport report = MobilityAnalysis.Of(scene.Mechanism());
        Assert.That((report.FirstOrder, report.Mobility), Is.EqualTo((2, 1)));
    }

    // All joints in one point but for the file's rounding: its 1e-13 m are no length of a link.
    [Test]
    public void Mobility_JointsInOnePoint_RoundingIsNoLinkLength()
    {
        var scene = new MechanismScene();
        Vector3d at = new(0.1, -0.2, 0.3), rounded = at + new Vector3d(3e-13, -4e-13, 2e-13);
        Vector3d normal = PlanarMechanisms.Polar(1, 20);
        int middle = scene.Body("middle", at);
        int cone = scene.Body("cone", new Vector3d(0.15, -0.1, 0.2));
        scene.Configurable(middle, null, at, normal, Vector3d.UnitZ, "LFFFLL");
        scene.Hinge(middle, cone, rounded, Vector3d.UnitX);
        scene.Ball(cone, null, at);
        Assert.That(MobilityAnalysis.Of(scene.Mechanism()).Mobility, Is.EqualTo(2));
    }

    private static TestCaseData Case(string name, Func<Mechanism> make, int rows, int firstOrder, int finite) =>
        new TestCaseData(make, rows, firstOrder, finite).SetArgDisplayNames(name);

    private static FourBar Flat() => new(0.5, 1, 0.5, 1, 0);

    // Crank at acos((a^2 + d^2 - (b + c)^2) / (2 a d)): coupler and rocker in a line.
    private static FourBar Toggle() => new(0.7, 0.9, 0.8, 1.5, Math.Acos((0.49 + 2.25 - 2.89) / 2.1) * 180 / Math.PI - 1e-13);

    private static Mechanism MiddleBar()
    {
        var bar = new FourBar(0.5, 1, 0.5, 1, 60);
        Vector3d top = PlanarMechanisms.Polar(0.5, 60) + PlanarMechanisms.At(0.4, 0);
        int middle = bar.Scene.Body("middle", top * 0.5);
        bar.Scene.Hinge(middle, null, PlanarMechanisms.At(0.4, 0), Vector3d.UnitZ);
        bar.Scene.Hinge(middle, bar.Coupler, top, Vector3d.UnitZ);
        return bar.Scene.Mechanism();
    }

    private static Mechanism Truss()
    {
        var scene = new MechanismScene();
        Vector3d top = PlanarMechanisms.At(0.4, 0.9);
        int a = scene.Body("a", top * 0.5);
        int b = scene.Body("b", top);
        scene.Hinge(a, null, Vector3d.Zero, Vector3d.UnitZ);
        scene.Hinge(b, null, Vector3d.UnitX, Vector3d.UnitZ);
        scene.Hinge(a, b, top, Vector3d.UnitZ);
        return scene.Mechanism();
    }

    // The platform is 0.6 of the base in shape; turned by 90 degrees it moves, though 6 rods hold it.
    private static Mechanism Hexapod(double turn)
    {
        Vector3d[] feet = SpatialMechanisms.Hexagon(1, 0, 10, 0);
        Vector3d[] heads = turn == 0
            ? [.. SpatialMechanisms.Hexagon(0.6, 60, 10, 1.2).TakeLast(1), .. SpatialMechanisms.Hexagon(0.6, 60, 10, 1.2).SkipLast(1)]
            : SpatialMechanisms.Hexagon(0.6, turn, 10, 1.2);
        return SpatialMechanisms.Rods(feet, heads).Scene.Mechanism();
    }
}
