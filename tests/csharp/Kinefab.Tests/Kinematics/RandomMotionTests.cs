using System;
using System.Linq;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>What must hold whatever the mechanism is and however it is pulled: finite, closed, within limits, never run away.</summary>
public class RandomMotionTests
{
    private const int Mechanisms = 200;
    private const int CallsEach = 5;

    [Test]
    public void Drag_AThousandTimesOnRandomMechanisms_StaysFiniteClosedAndWithinLimits()
    {
        for (int seed = 0; seed < Mechanisms; seed++)
        {
            var random = new Random(1000 + seed);
            Mechanism mechanism = RandomScene.Make(seed).Mechanism();
            MechanismState state = mechanism.NewState();
            var solver = new PositionSolver(mechanism);
            for (int i = 0; i < CallsEach; i++)
            {
                double reach = i == 3 ? 1000 : 2;
                double Next(double scale) => (random.NextDouble() * 2 - 1) * scale;
                int body = random.Next(mechanism.Scene.Document.GameObjects.Count);
                var point = new Vector3d(Next(0.3), Next(0.3), Next(0.3));
                var target = new Vector3d(Next(reach), Next(reach), Next(reach));
                double before = (state.Pose(body).Point(point) - target).Length;
                DriveResult result = solver.Drag(state, body, point, target);
                double after = (state.Pose(body).Point(point) - target).Length;
                Assert.That(result.Status, Is.Not.EqualTo(DriveStatus.NotClosed), $"mechanism {seed}, drag {i}");
                Assert.That(after, Is.LessThanOrEqualTo(before * (1 + 1e-9)), $"mechanism {seed}, drag {i} leads away");
                AssertSound(mechanism, state, solver, result, $"mechanism {seed}, drag {i}");
            }
        }
    }

    [Test]
    public void Drive_RandomCoordinatesOfRandomMechanisms_StopsSomewhereSound()
    {
        for (int seed = 0; seed < Mechanisms; seed++)
        {
            var random = new Random(2000 + seed);
            Mechanism mechanism = RandomScene.Make(seed).Mechanism();
            MechanismState state = mechanism.NewState();
            var solver = new PositionSolver(mechanism);
            for (int i = 0; i < CallsEach; i++)
            {
                int coordinate = random.Next(mechanism.Coordinates.Count);
                double target = (random.NextDouble() - 0.5) * (mechanism.Coordinates[coordinate].IsAngle ? 500 : 3);
                DriveResult result = solver.Drive(state, coordinate, target);
                Assert.That(result.Status, Is.Not.EqualTo(DriveStatus.NotClosed), $"mechanism {seed}, drive {i}");
                Assert.That(result.Converged, Is.EqualTo(Math.Abs(state.Coordinate(coordinate) - target) < 1e-7), $"mechanism {seed}, drive {i}: {result.Status}");
                Assert.That(result.Status == DriveStatus.StoppedByLimit, Is.EqualTo(result.Limit is not null && !result.Converged), $"mechanism {seed}, drive {i}");
                AssertSound(mechanism, state, solver, result, $"mechanism {seed}, drive {i}");
            }
        }
    }

    // Each body turned by 0.1 rad and shifted; what a loop cannot close is said in metres and degrees.
    [Test]
    public void Close_RandomMechanismsATenthOfARadianOff_ConvergesOrSaysWhatIsLeft()
    {
        int closed = 0;
        for (int seed = 0; seed < Mechanisms; seed++)
        {
            var random = new Random(3000 + seed);
            Mechanism mechanism = RandomScene.Make(seed).Mechanism();
            MechanismState state = mechanism.NewState();
            for (int i = 0; i < mechanism.Scene.Document.GameObjects.Count; i++)
            {
                Vector3d axis = new Vector3d(random.NextDouble() - 0.5, random.NextDouble() - 0.5, random.NextDouble() - 0.5).Normalized();
                Pose pose = state.Pose(i);
                state.SetPose(i, new Pose(pose.Position + 0.02 * axis, Quaterniond.AxisAngle(axis, 0.1) * pose.Rotation));
            }

            DriveResult result = new PositionSolver(mechanism).Close(state);
            closed += result.Converged ? 1 : 0;
            Assert.That(double.IsFinite(result.ErrorMetres) && double.IsFinite(result.ErrorDegrees), $"mechanism {seed}");
            Assert.That(result.Converged, Is.EqualTo(result.ErrorMetres < 1e-9 && result.ErrorDegrees < 1e-7), $"mechanism {seed}: {result.ErrorMetres} m, {result.ErrorDegrees} deg");
        }

        Assert.That(closed, Is.EqualTo(Mechanisms));
    }

    private static void AssertSound(Mechanism mechanism, MechanismState state, PositionSolver solver, DriveResult result, string where)
    {
        Assert.That(result.ErrorMetres, Is.LessThan(1e-9), where);
        Assert.That(result.ErrorDegrees, Is.LessThan(1e-7), where);
        Assert.That(Enumerable.Range(0, mechanism.Coordinates.Count).All(k => double.IsFinite(state.Coordinate(k))), where);
        Assert.That(state.Poses.All(p => p.Position.IsFinite && Math.Abs(p.Rotation.LengthSquared - 1) < 1e-12), where);
        solver.Newton.Limits.Begin(mechanism.NewState());
        solver.Newton.Limits.Measure(state);
        Assert.That(solver.Newton.Limits.Worst(1e-8), Is.EqualTo(-1), $"{where}: a limit is broken");
    }
}
