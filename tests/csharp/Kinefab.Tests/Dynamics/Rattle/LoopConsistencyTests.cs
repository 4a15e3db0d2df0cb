using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Loops whose axes are a little off are named when the world is made, and no others.</summary>
internal sealed class LoopConsistencyTests
{
    private static readonly string Fixtures = Path.Combine(Scenario.Folder, "..", "..", "fixtures");

    [TestCase(1e-3)]
    [TestCase(1e-2)]
    [TestCase(-2e-2)]
    public void Find_TiltedAxis_NamesTheLoop(double tilt)
    {
        InconsistentLoop loop = LoopConsistencyProbe.Find(SolverScenes.FourBars(1, tilt)).Single();
        Assert.That((loop.Consistency, loop.Joints), Is.EqualTo((LoopConsistency.Inconsistent, Enumerable.Range(0, 4))));
    }

    [TestCase(1e-5)]
    [TestCase(1e-4)]
    public void Find_LoopThatAFileRounded_IsRounded(double tilt)
    {
        Assert.That(LoopConsistencyProbe.Find(SolverScenes.FourBars(1, tilt)).Single().Consistency, Is.EqualTo(LoopConsistency.Rounded));
    }

    [TestCase(0)]
    [TestCase(1e-7)]
    public void Find_ExactLoop_NamesNothing(double tilt)
    {
        Assert.That(LoopConsistencyProbe.Find(SolverScenes.FourBars(1, tilt)), Is.Empty);
    }

    // Slow velocities far along their way, in loops that are closed to the letter and move.
    [Test]
    public void Find_LoopsNearASingularPose_NamesNothing([Values(301, 628, 745, 1192, 1201, 1555)] int seed)
    {
        Assert.That(LoopConsistencyProbe.Find(new RandomLoop(seed).System), Is.Empty);
    }

    /// <summary>
    /// Closed to the letter, it stands, and nearly bends: what is slow ends beside where it stands, on one side at least. It was taken for axes that are off,
    /// and gave by any angle; the loop beside it is judged by itself.
    /// </summary>
    [Test]
    public void Find_FrameNearASingularPose_SaysWhatTheLoopBesideItIs([Values(2, 5, 16, 23, 24, 28, 47, 50)] int seed)
    {
        Assert.That(LoopConsistencyProbe.Find(LoopScenes.Elbow(seed, null)), Is.Empty);
        Assert.That(LoopConsistencyProbe.Find(LoopScenes.Elbow(seed, 0)), Is.Empty);
        Assert.That(LoopConsistencyProbe.Find(LoopScenes.Elbow(seed, 1e-5)).Single().Consistency, Is.EqualTo(LoopConsistency.Rounded));
        Assert.That(LoopConsistencyProbe.Find(LoopScenes.Elbow(seed, 1e-2)).Single().Consistency, Is.EqualTo(LoopConsistency.Inconsistent));
    }

    /// <summary>
    /// Their hinges come to the ends of their ways and to flat poses long before half a turn, and are off all the same. Few give too little at first.
    /// </summary>
    [Test]
    public void Find_PolygonsWithATiltedHinge_NamesNearlyAll()
    {
        const int count = 200, leastNamed = 190;
        int named = Enumerable.Range(0, count).Count(IsNamed);
        Assert.That(named, Is.GreaterThanOrEqualTo(leastNamed));

        static bool IsNamed(int seed) =>
            LoopConsistencyProbe.Find(LoopScenes.Polygons(seed)).Exists(loop => loop.Consistency == LoopConsistency.Inconsistent);
    }

    // Wide enough to bend out of its plane with little turn between neighbours; its hinges do not turn then.
    [TestCase(8)]
    [TestCase(10)]
    public void Create_ExactGridOfCells_NamesNothing(int cells)
    {
        ValidScene scene = SmallScene.Validate(HubScenes.Grid(cells));
        Assert.That(World.Create(scene, SolverKind.Exact).Findings.Diagnostics, Is.Empty);
    }

    /// <summary>Gears make no loop of axes, however slowly the joints beside them would turn the axes apart.</summary>
    [Test]
    public void Find_RandomChainsWithGears_NamesNothing()
    {
        var random = new Random(7);
        for (int chain = 0; chain < 200; chain++)
        {
            var b = new MechanismBuilder();
            Vector3d at = Vector3d.Zero;
            int last = JointModel.World;
            var hinges = new RevoluteJoint[6];
            for (int i = 0; i < hinges.Length; i++)
            {
                Vector3d next = at + Math.Pow(10, -1.5 * random.NextDouble()) * Direction();
                int body = b.Bar(at, next, Math.Pow(10, random.NextDouble() - 0.5));
                hinges[i] = b.Hinge(last, body, at, Direction());
                (last, at) = (body, next);
            }

            foreach (int i in new[] { 1, 2, 4, 5 })
            {
                b.Couple(hinges[i], (hinges[i - 1], -4 * random.NextDouble()));
            }

            Assert.That(LoopConsistencyProbe.Find(b.Build()), Is.Empty, $"chain {chain}");
        }

        Vector3d Direction() => new Vector3d(random.NextDouble() - 0.5, random.NextDouble() - 0.5, random.NextDouble() - 0.5).Normalized();
    }

    [Test]
    public void Find_RedundantAndSingularLoops_NamesNothing()
    {
        MultibodySystem[] healthy =
        {
            SolverScenes.Parallelogram(), SolverScenes.SliderCrank(), SolverScenes.FourBars(10),
            BenchmarkMechanisms.Windows(8).MultibodySystem, BenchmarkMechanisms.Squeezer().MultibodySystem,
            BenchmarkMechanisms.Bricard().MultibodySystem, BenchmarkMechanisms.Governor().MultibodySystem,
            BenchmarkMechanisms.Lever().MultibodySystem,
        };
        Assert.That(healthy.SelectMany(mechanism => LoopConsistencyProbe.Find(mechanism)), Is.Empty);
    }

    [Test]
    public void Create_EveryFixture_NamesNoLoop()
    {
        string[] files = Directory.GetFiles(Fixtures, "*.kinefab", SearchOption.AllDirectories);
        var named = new List<string>();
        foreach (string file in files)
        {
            World world = World.Create(ValidScene.Load(file), SolverKind.Exact);
            named.AddRange(world.Findings.Diagnostics.Where(d => d.Code == DiagnosticCodes.LoopInconsistent).Select(_ => file));
        }

        Assert.That(files, Has.Length.GreaterThanOrEqualTo(40));
        Assert.That(named, Is.Empty);
    }

    [Test]
    public void Create_TiltedFourBar_FindingNamesItsJoints([Values] SolverKind solver)
    {
        Diagnostic found = World.Create(FourBar(0.01), solver).Findings.Diagnostics.Single();

        Assert.That((found.Code, found.Severity, found.Pointer), Is.EqualTo((DiagnosticCodes.LoopInconsistent, Severity.Warning, "/gameObjects/0/components/1")));
        Assert.That(found.Message, Does.Contain("crank, coupler, rocker"));
        Assert.That(World.Create(FourBar(0), solver).Findings.Diagnostics, Is.Empty);
    }

    // Crank-rocker of 0.4, 0.9 and 0.7 m on a ground of 1 m, the axis between coupler and rocker turned by an angle.
    private static ValidScene FourBar(double tilt)
    {
        var b = new Vector3d(0.4 * Math.Cos(1), 0.4 * Math.Sin(1), 0);
        var d = new Vector3d(1, 0, 0);
        Vector3d bd = d - b;
        double along = (bd.LengthSquared + 0.81 - 0.49) / (2 * bd.Length);
        Vector3d u = bd * (1 / bd.Length);
        Vector3d c = b + u * along + new Vector3d(-u.Y, u.X, 0) * Math.Sqrt(0.81 - along * along);
        return SmallScene.Validate(new SceneDocument
        {
            GameObjects =
            [
                new() { Id = "crank", Name = "crank", Components = [new Rigidbody(), Hinge(Vector3d.Zero, null, 0), Hinge(b, 1, 0)] },
                new() { Id = "coupler", Name = "coupler", Transform = new Transform { LocalPosition = b }, Components = [new Rigidbody(), Hinge(c - b, 2, tilt)] },
                new() { Id = "rocker", Name = "rocker", Transform = new Transform { LocalPosition = d }, Components = [new Rigidbody(), Hinge(Vector3d.Zero, null, 0)] },
            ],
        });
    }

    private static HingeJoint Hinge(Vector3d anchor, int? connected, double tilt) => new()
    {
        Anchor = anchor, Axis = new Vector3d(Math.Sin(tilt), 0, Math.Cos(tilt)), ConnectedBody = connected, AutoConfigureConnectedAnchor = true,
    };
}
