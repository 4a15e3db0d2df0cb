using System.Linq;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>Mobility by blocks: each is as large as what it moves, and counts what it would by itself.</summary>
public sealed class LoopPartTests
{
    [Test]
    public void Parts_ManyMechanismsOnOneFreeBody_AreAsLargeAsOne()
    {
        var scene = new MechanismScene();
        int car = scene.Body("car", Vector3d.Zero);
        for (int i = 0; i < 5; i++)
        {
            AddFourBar(scene, car, new Vector3d(3 * i, 0, 0));
            scene.Hinge(scene.Body("door" + i, new Vector3d(3 * i, 2, 0)), car, new Vector3d(3 * i, 2, 0), Vector3d.UnitY);
        }

        Mechanism mechanism = scene.Mechanism();
        IndependentLinkages parts = PartsOf(mechanism);
        MobilityReport report = MobilityAnalysis.Of(mechanism);

        // Three bars and the car, which stands still.
        Assert.That(string.Join(" ", Enumerable.Range(0, parts.Count).Select(b => parts.Make(b, mechanism.NewState().Poses).Linkage.BodyCount)), Is.EqualTo("4 4 4 4 4"));
        Assert.That((report.Mobility, report.FirstOrder, report.AtGeneralPose, report.Redundant), Is.EqualTo((16, 16, 16, 15)));
        Assert.That(string.Join(" ", report.Joints.Select(j => j.Redundant)), Is.EqualTo("3 3 3 3 3"));
    }

    [Test]
    public void Parts_FourBarsOnEachOthersRockers_CountAsByThemselves()
    {
        var scene = new MechanismScene();
        int? on = null;
        for (int i = 0; i < 4; i++)
        {
            on = AddFourBar(scene, on, new Vector3d(1.3 * i, 0.1 * i * i, 0)); // feet in one line would make twists repeat
        }

        MobilityReport report = MobilityAnalysis.Of(scene.Mechanism());

        // Planar bodies: those of the second turn about two poles, those of the third and fourth about three and more.
        Assert.That(string.Join(" ", report.Bodies.Select(b => b.Translations + "+" + b.Rotations)), Is.EqualTo("0+1 0+1 0+1 1+1 1+1 1+1 2+1 2+1 2+1 2+1 2+1 2+1"));
        Assert.That((report.Mobility, report.Redundant, report.Islands.Count), Is.EqualTo((4, 12, 1)));
    }

    // A finger: its first joint slides and turns, its last follows the turn, and one between them belongs to no block.
    [Test]
    public void Parts_FreedomOfNoBlockBetweenTwoOfOne_IsCarriedAlong()
    {
        var scene = new MechanismScene();
        int first = scene.Body("first", Vector3d.Zero);
        JointPlace sliding = scene.Configurable(first, null, Vector3d.Zero, Vector3d.UnitZ, Vector3d.UnitX, "FLLFLL");
        int middle = scene.Body("middle", Vector3d.UnitX);
        scene.Hinge(middle, first, Vector3d.UnitX, new Vector3d(0.2, 0.1, 1));
        int last = scene.Body("last", new Vector3d(2, 0, 0));
        JointPlace tip = scene.Hinge(last, middle, new Vector3d(2, 0.2, 0), new Vector3d(0, 1, 0.3));
        scene.Couple(sliding, Coordinate.AngularX, tip, Coordinate.Angle, 0.7);
        Mechanism mechanism = scene.Mechanism();
        IndependentLinkages parts = PartsOf(mechanism);

        MobilityReport report = MobilityAnalysis.Of(mechanism);

        IndependentLinkage part = parts.Make(0, mechanism.NewState().Poses);
        Assert.That((parts.Count, string.Join(" ", part.Bodies), part.Linkage.Tree.Freedoms[part.IndexOf(middle)]), Is.EqualTo((1, "0 1 2", 0)));
        Assert.That(string.Join(" ", report.Bodies.Select(b => b.Translations + b.Rotations)), Is.EqualTo("2 3 3"));
        Assert.That((report.Mobility, report.Idle.Count), Is.EqualTo((3, 0)), "the slide carries the tip: it is not idle");
    }

    [Test]
    public void Report_OfAMechanismThatDoesNotClose_LeavesItsNeighboursAlone()
    {
        // The second one's rod is too short by 0.1 m: nothing brings it together.
        var scene = new MechanismScene();
        AddFourBar(scene, null, Vector3d.Zero);
        int a = scene.Body("a", new Vector3d(5, 0, 0));
        int b = scene.Body("b", new Vector3d(6, 0, 0));
        scene.Hinge(a, null, new Vector3d(5, 0, 0), Vector3d.UnitZ);
        scene.Hinge(b, a, new Vector3d(5.5, 0, 0), Vector3d.UnitZ);
        scene.Configurable(b, null, new Vector3d(6, 0, 0), Vector3d.UnitX, Vector3d.UnitY, "LLLFFF", closure: true, shift: 0.1);

        MobilityReport report = MobilityAnalysis.Of(scene.Mechanism());

        Assert.That((report.Islands.Count, report.Islands[0].Mobility, report.Islands[0].Redundant), Is.EqualTo((2, 1, 3)));
    }

    private static int AddFourBar(MechanismScene scene, int? ground, Vector3d at)
    {
        Vector3d a = at + new Vector3d(0.3, 0.4, 0), b = at + new Vector3d(1.4, 0.7, 0), foot = at + new Vector3d(1.1, 0, 0);
        int crank = scene.Body("crank" + at.X, at);
        int rod = scene.Body("rod" + at.X, a);
        int rocker = scene.Body("rocker" + at.X, b);
        scene.Hinge(crank, ground, at, Vector3d.UnitZ);
        scene.Hinge(rod, crank, a, Vector3d.UnitZ);
        scene.Hinge(rocker, rod, b, Vector3d.UnitZ);
        scene.Hinge(rocker, ground, foot, Vector3d.UnitZ, closure: true);
        return rocker;
    }

    private static IndependentLinkages PartsOf(Mechanism mechanism)
    {
        var newton = new NewtonSolver(mechanism.Linkage);
        var blocks = new FreedomBlocks(mechanism.Linkage, newton.Firsts, newton.Motion.Linear.Length);
        return new IndependentLinkages(mechanism.Linkage, blocks, newton.Firsts);
    }
}
