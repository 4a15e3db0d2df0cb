using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Tests.Dynamics;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>What holds for every drive, drag and closing: bits, memory, limits, finite numbers.</summary>
public class PositionSolverTests
{
    [Test]
    public void Drive_TwoDrivers_PutTheFiveBarsTipWhereTheCirclesMeet()
    {
        (MechanismScene scene, JointPlace left, JointPlace right, int link, Vector3d tip) = PlanarMechanisms.FiveBar(80, 110);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        CoordinateTarget[] targets = [new(left.Angle(mechanism), 30), new(right.Angle(mechanism), -15)];
        DriveResult result = new PositionSolver(mechanism).Drive(state, targets);
        (_, _, _, _, Vector3d expected) = PlanarMechanisms.FiveBar(110, 95);
        Assert.That(result.Converged, Is.True);
        Assert.That((state.Pose(link).Point(scene.Local(link, tip)) - expected).Length, Is.LessThan(1e-9));
    }

    [Test]
    public void Drive_SameInputTwice_GivesTheSameBits()
    {
        MechanismState first = Run();
        MechanismState second = Run();
        for (int i = 0; i < 4; i++)
        {
            Assert.That(first.Pose(i).Position == second.Pose(i).Position && first.Pose(i).Rotation == second.Pose(i).Rotation);
        }

        static MechanismState Run()
        {
            (MechanismScene scene, JointPlace left, JointPlace right, int link, Vector3d tip) = PlanarMechanisms.FiveBar(80, 110);
            Mechanism mechanism = scene.Mechanism();
            MechanismState state = mechanism.NewState();
            var solver = new PositionSolver(mechanism);
            solver.Drive(state, left.Angle(mechanism), 12);
            solver.Drag(state, link, scene.Local(link, tip), tip + new Vector3d(0.03, 0.02, 0));
            solver.Drive(state, right.Angle(mechanism), 5);
            return state;
        }
    }

    [Test]
    public void DriveAndDrag_AfterTheFirstCalls_AllocateNothing()
    {
        (MechanismScene scene, JointPlace left, _, int link, Vector3d tip) = PlanarMechanisms.FiveBar(80, 110);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        var solver = new PositionSolver(mechanism);
        Vector3d point = scene.Local(link, tip);
        int angle = left.Angle(mechanism);
        for (int i = 0; i < 3; i++)
        {
            solver.Drive(state, angle, i);
            solver.Drag(state, link, point, tip + new Vector3d(0.01 * i, 0.3, 0));
        }

        MechanismState copy = state.Clone();
        Assert.That(AllocatedBytes.LeastOf(Run), Is.Zero);

        void Run()
        {
            for (int i = 0; i < 50; i++)
            {
                solver.Drive(state, angle, i % 7);
                solver.Drag(state, link, point, tip + new Vector3d(0.01 * (i % 5), 0.3, 0));
                copy.CopyFrom(state);
            }
        }
    }

    [TestCase("M09", "shaft", "sliderD")]
    [TestCase("M14", "lo1.x", "platform")]
    [TestCase("M27", "sun", "planet")]
    [TestCase("M04", "crank", "coupler")]
    public void DriveAndDragByName_OfExportedScenes_AllocateNothing(string id, string joint, string part)
    {
        var exported = new ExportedMechanism(id);
        Run(10);
        Assert.That(AllocatedBytes.LeastOf(() => Run(50)), Is.Zero);

        void Run(int rounds)
        {
            double unit = id == "M14" ? 1e-4 : 1;
            for (int i = 0; i < rounds; i++)
            {
                exported.Solver.Drive(exported.State, joint, unit * (i % 9));
                exported.Solver.Drag(exported.State, part, Vector3d.Zero, exported.State.Pose(part).Position + new Vector3d(0.01, 0.01 * (i % 3), 0));
            }
        }
    }

    [Test]
    public void Drag_WithinReach_BringsThePointThereWithJointsClosed()
    {
        (MechanismScene scene, _, _, int link, Vector3d tip) = PlanarMechanisms.FiveBar(80, 110);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        Vector3d target = tip + new Vector3d(-0.05, -0.15, 0);
        DriveResult result = new PositionSolver(mechanism).Drag(state, link, scene.Local(link, tip), target);
        Assert.That(result.Converged, Is.True, $"{result.Status} {result.Fraction}");
        Assert.That((state.Pose(link).Point(scene.Local(link, tip)) - target).Length, Is.LessThan(1e-9));
        Assert.That(result.ErrorMetres, Is.LessThan(1e-11));
    }

    [Test]
    public void Drag_OutOfReach_PointsTheChainAtTheTarget()
    {
        (MechanismScene scene, _, int last, Vector3d tip) = PlanarMechanisms.Chain(5);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        var target = new Vector3d(1.2, 1.6, 0);
        DriveResult result = new PositionSolver(mechanism).Drag(state, last, scene.Local(last, tip), target);
        Vector3d reached = state.Pose(last).Point(scene.Local(last, tip));
        Assert.That(result.Status, Is.EqualTo(DriveStatus.OutOfReach));
        Assert.That((reached - target).Length, Is.EqualTo(2 - 0.5).Within(1e-5), $"{reached} after {result.Iterations}");
    }

    [Test]
    public void Drag_IntoALimit_SlidesAlongIt()
    {
        // Links 1 and 1; the first may turn by 20 degrees only, so the second alone aims at the target from its end.
        var scene = new MechanismScene();
        int first = scene.Body("first", Vector3d.UnitX);
        int second = scene.Body("second", new Vector3d(1.5, 0.1, 0));
        JointPlace joint = scene.Hinge(first, null, Vector3d.Zero, Vector3d.UnitZ, -20, 20);
        scene.Hinge(second, first, Vector3d.UnitX, Vector3d.UnitZ);
        Mechanism mechanism = scene.Mechanism();
        MechanismState state = mechanism.NewState();
        var target = new Vector3d(0.5, 3, 0);
        DriveResult result = new PositionSolver(mechanism).Drag(state, second, scene.Local(second, new Vector3d(2, 0, 0)), target);
        Vector3d elbow = PlanarMechanisms.Polar(1, 20);
        Vector3d expected = elbow + (target - elbow).Normalized();
        Vector3d got = state.Pose(second).Point(scene.Local(second, new Vector3d(2, 0, 0)));
        Assert.That(result.Status, Is.EqualTo(DriveStatus.StoppedByLimit));
        Assert.That(result.Limit?.IsUpper, Is.True);
        Assert.That(state.Coordinate(joint.Angle(mechanism)), Is.EqualTo(20).Within(1e-6));
        Assert.That((got - target).Length, Is.EqualTo((expected - target).Length).Within(1e-6), $"after {result.Iterations}");
    }

    [Test]
    public void Drag_AThousandRandomTargets_StaysFiniteClosedAndWithinLimits()
    {
        var random = new Random(7);
        foreach ((MechanismScene scene, int body, int drags) in Draggable())
        {
            Mechanism mechanism = scene.Mechanism();
            MechanismState state = mechanism.NewState();
            var solver = new PositionSolver(mechanism);
            for (int i = 0; i < drags; i++)
            {
                double reach = i % 10 == 0 ? 100 : 2;
                var target = new Vector3d(Next(reach), Next(reach), Next(reach));
                DriveResult result = solver.Drag(state, body, new Vector3d(Next(0.3), Next(0.3), Next(0.3)), target);
                Assert.That(result.Status, Is.Not.EqualTo(DriveStatus.NotClosed));
                Assert.That(result.ErrorMetres, Is.LessThan(1e-9));
                Assert.That(result.ErrorDegrees, Is.LessThan(1e-7));
                solver.Newton.Limits.Begin(mechanism.NewState());
                solver.Newton.Limits.Measure(state);
                Assert.That(solver.Newton.Limits.Worst(1e-8), Is.EqualTo(-1), "a limit is broken");
                for (int k = 0; k < mechanism.Coordinates.Count; k++)
                {
                    Assert.That(double.IsFinite(state.Coordinate(k)));
                }
            }
        }

        double Next(double scale) => (random.NextDouble() * 2 - 1) * scale;
    }

    [Test]
    public void Close_StartsATenthOfARadianOff_ConvergesOrSaysWhatIsLeft()
    {
        var random = new Random(3);
        int closed = 0;
        int runs = 0;
        foreach ((MechanismScene scene, _, _) in Draggable())
        {
            Mechanism mechanism = scene.Mechanism();
            var solver = new PositionSolver(mechanism);
            for (int i = 0; i < 40; i++)
            {
                MechanismState state = mechanism.NewState();
                for (int body = 0; body < state.Poses.Length; body++)
                {
                    Vector3d axis = new Vector3d(random.NextDouble() - 0.5, random.NextDouble() - 0.5, random.NextDouble() - 0.5).Normalized();
                    Pose pose = state.Poses[body];
                    state.Poses[body] = new Pose(pose.Position + axis * 0.02, Quaterniond.AxisAngle(axis, 0.1) * pose.Rotation);
                }

                DriveResult result = solver.Close(state);
                runs++;
                closed += result.Converged ? 1 : 0;
                Assert.That(result.Converged, Is.EqualTo(result.ErrorMetres < 1e-9 && result.ErrorDegrees < 1e-7));
                Assert.That(double.IsFinite(result.ErrorMetres));
            }
        }

        Assert.That(closed, Is.EqualTo(runs));
    }

    [Test]
    public void Drive_NotANumber_IsRefused()
    {
        var bar = new FourBar(0.4, 1.2, 0.8, 1, 25);
        var solver = new PositionSolver(bar.Mechanism);
        Assert.That(() => solver.Drive(bar.Mechanism.NewState(), bar.Drive, double.NaN), Throws.InstanceOf<ArgumentException>());
        Assert.That(() => solver.Drive(bar.Mechanism.NewState(), 99, 1), Throws.InstanceOf<ArgumentException>());
    }

    [TestCase("crank.angle")]
    [TestCase("crank")]
    [TestCase("crank[1]")]
    [TestCase("crank[1].Angle")]
    public void CoordinateNamed_AllItsNames_FindIt(string name)
    {
        Mechanism mechanism = new ExportedMechanism("M05").Mechanism;
        Assert.That(mechanism.Coordinates[mechanism.CoordinateNamed(name)].Name, Is.EqualTo("crank.angle"));
        Assert.That(() => mechanism.CoordinateNamed("rocker"), Throws.ArgumentException.With.Message.Contains("rocker[1].angle, rocker[2].angle"));
        Assert.That(() => mechanism.GameObjectNamed("nobody"), Throws.ArgumentException.With.Message.Contains("nobody"));
    }

    [Test]
    public void SetPose_OfAllBodies_ReadsTheCoordinatesThere()
    {
        var exported = new ExportedMechanism("M01");
        exported.Solver.Drive(exported.State, "crank", 400);
        MechanismState copy = exported.Mechanism.NewState();
        MechanismState together = exported.Mechanism.NewState();
        int[] bodies = [.. exported.Mechanism.Bodies];
        for (int turn = 1; turn <= 10; turn++)
        {
            MechanismState at = exported.Mechanism.NewState();
            exported.Solver.Drive(at, "crank", 40 * turn);
            foreach (int body in exported.Mechanism.Bodies)
            {
                copy.SetPose(body, at.Pose(body));
            }

            together.SetPoses(bodies, Array.ConvertAll(bodies, b => at.Pose(b)));
            for (int i = 0; i < exported.Mechanism.Coordinates.Count; i++)
                Assert.That(together.Coordinate(i), Is.EqualTo(copy.Coordinate(i)));
        }

        Assert.That(() => together.SetPoses(bodies, new Pose[1]), Throws.ArgumentException);

        Assert.That(copy.Coordinate("crank"), Is.EqualTo(400).Within(1e-9), "over a whole turn");
        Assert.That(copy.Pose("rocker").Position, Is.EqualTo(exported.State.Pose("rocker").Position));
        Assert.That(() => copy.SetPose(exported.Mechanism.GameObjectNamed("base"), Pose.Identity), Throws.ArgumentException);
        Assert.That(() => copy.SetPose(exported.Mechanism.GameObjectNamed("crank"), new Pose(new Vector3d(double.NaN, 0, 0), Quaterniond.Identity)), Throws.ArgumentException);
    }

    // More rows than the dual matrix takes and fewer give the same step.
    [TestCase(10, 3)]
    [TestCase(100, 3)]
    [TestCase(30, 29)]
    public void Solve_FewRowsOrMany_IsTheDampedLeastSquaresStep(int freedoms, int rows)
    {
        var scene = new MechanismScene();
        int? previous = null;
        for (int i = 0; i < freedoms; i++)
        {
            int link = scene.Body($"link{i}", new Vector3d(i, 0.1 * i * i, 0));
            scene.Hinge(link, previous, new Vector3d(i, 0, 0), Vector3d.UnitZ);
            previous = link;
        }

        Mechanism mechanism = scene.Mechanism();
        RowPath path = RowPath.Between(mechanism.Tree, previous!.Value, KinematicTree.Ground);
        var normal = new NormalEquations(mechanism.Tree, [path]);
        var random = new Random(5);
        var matrix = new double[rows][];
        var c = new double[rows];
        normal.Clear();
        for (int r = 0; r < rows; r++)
        {
            matrix[r] = Enumerable.Range(0, path.Width).Select(_ => random.NextDouble() - 0.5).ToArray();
            c[r] = random.NextDouble() - 0.5;
            normal.Add(path, matrix[r], c[r]);
        }

        normal.Solve(1e-3);
        double largest = Math.Max(1, Enumerable.Range(0, path.Width).Max(k => matrix.Sum(row => row[k] * row[k])));
        for (int k = 0; k < path.Width; k++)
        {
            // (J^T J + mu) dy + J^T C = 0
            double left = 1e-3 * largest * Step(k);
            for (int r = 0; r < rows; r++)
            {
                left += matrix[r][k] * (c[r] + Enumerable.Range(0, path.Width).Sum(l => matrix[r][l] * Step(l)));
            }

            Assert.That(left, Is.EqualTo(0).Within(1e-12));
        }

        // The path runs from the last body to the ground.
        double Step(int entry) => normal.Step[normal.Firsts[path.Bodies[entry]]];
    }

    private static IEnumerable<(MechanismScene Scene, int Body, int Drags)> Draggable()
    {
        yield return (new FourBar(0.4, 1.2, 0.8, 1, 25, -70, 20).Scene, 1, 400);
        (MechanismScene fiveBar, _, _, int link, _) = PlanarMechanisms.FiveBar(80, 110);
        yield return (fiveBar, link, 300);
        yield return (SpatialMechanisms.Arm(60).Scene, 5, 150);
        yield return (SpatialMechanisms.Stewart(withUniversals: true).Scene, 0, 20);
        yield return (SpatialMechanisms.Sarrus(40).Scene, 0, 130);
    }
}
