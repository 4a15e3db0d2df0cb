using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>Which coordinates stand for a mechanism's freedoms, what they are called, and a state kept as numbers.</summary>
public sealed class FreedomTests
{
    // Counts from Gruebler's formula, without the spins of rods between two balls.
    private static IEnumerable<TestCaseData> Counted()
    {
        yield return Case("crank-rocker", () => new FourBar(0.4, 1.2, 0.8, 1, 25).Mechanism, 1);
        yield return Case("parallelogram", () => new FourBar(0.5, 1, 0.5, 1, 60).Mechanism, 1);
        yield return Case("Bennett", () => SpatialMechanisms.Bennett(60).Scene.Mechanism(), 1);
        yield return Case("Stewart 6-UPS", () => SpatialMechanisms.Stewart(true).Scene.Mechanism(), 6);
        yield return Case("Stewart 6-SPS", () => SpatialMechanisms.Stewart(false).Scene.Mechanism(), 6);
        yield return Case("Delta of ball rods", () => SpatialMechanisms.Delta(true).Scene.Mechanism(), 3);
        yield return Case("five-bar", () => PlanarMechanisms.FiveBar(80, 110).Scene.Mechanism(), 2);
        yield return Case("6R arm", () => SpatialMechanisms.Arm().Scene.Mechanism(), 6);
        yield return Case("ladder of 40", () => PlanarMechanisms.Ladder(40, 90).Scene.Mechanism(), 1);
    }

    [TestCaseSource(nameof(Counted))]
    public void Freedoms_KnownMechanism_AreAsManyAsItsMotions(Func<Mechanism> make, int expected)
    {
        Mechanism mechanism = make();
        IReadOnlyList<int> chosen = mechanism.ChooseFreedoms();
        Assert.That(chosen, Has.Count.EqualTo(expected).And.Unique.And.Ordered);

        // Each moves by itself, the others held.
        var solver = new PositionSolver(mechanism);
        foreach (int moved in chosen)
        {
            MechanismState state = mechanism.NewState();
            DriveResult result = solver.Drive(state, chosen.Select(i => new CoordinateTarget(i, i == moved ? (mechanism.Coordinates[i].IsAngle ? 0.5 : 0.001) : 0)).ToArray());
            Assert.That(result.Converged, Is.True, $"{mechanism.Coordinates[moved]}: {result}");
        }
    }

    [TestCaseSource(nameof(Files))]
    public void Freedoms_OfAFixture_AreTheMobilityButForIdleOnes(string file)
    {
        Mechanism mechanism = Mechanism.Load(file);
        MobilityReport report = mechanism.CountMobility();

        // An idle slide has a coordinate, an idle spin between two balls has none.
        Assert.That(mechanism.ChooseFreedoms(), Has.Count.InRange(report.Mobility - report.Idle.Sum(idle => idle.Count), report.Mobility));
        foreach (MechanismCoordinate coordinate in mechanism.Coordinates.Where(c => !c.IsLocked))
            Assert.That(mechanism.Coordinates[mechanism.CoordinateNamed(coordinate.ShortName)], Is.SameAs(coordinate));
    }

    // One angle of the ball follows a hinge. The others are freedoms that can be named, and so held: left alone they drift by degrees, since what is
    // turned about one axis after the other does not come back.
    [Test]
    public void Freedoms_OfABallThatACouplingTies_AreItsOtherAngles()
    {
        const ConfigurableJointMotion free = ConfigurableJointMotion.Free;
        var ball = new ConfigurableJoint
        {
            XMotion = ConfigurableJointMotion.Locked,
            YMotion = ConfigurableJointMotion.Locked,
            ZMotion = ConfigurableJointMotion.Locked,
            AngularXMotion = free,
            AngularYMotion = free,
            AngularZMotion = free,
            Anchor = new Vector3d(0.3, 0.2, -0.1),
        };
        var document = new SceneDocument
        {
            GameObjects =
            [
                new GameObject { Id = "A", Name = "A", Components = [new Rigidbody(), ball] },
                new GameObject { Id = "B", Name = "B", Transform = new Transform { LocalPosition = new(2, 0.4, 0.3) }, Components = [new Rigidbody(), new HingeJoint { Axis = new(0.2, 0.3, 1) }] },
            ],
            Couplings =
            [
                new Coupling
                {
                    Id = "c",
                    A = new JointCoordinate { GameObject = 0, Component = 1, Coordinate = Coordinate.AngularX },
                    B = new JointCoordinate { GameObject = 1, Component = 1, Coordinate = Coordinate.Angle },
                    Ratio = 0.5,
                },
            ],
        };
        Mechanism mechanism = Mechanism.Create(SceneValidator.Validate(document).Scene!);
        string[] names = ["A.angularY", "A.angularZ", "B.angle"];
        Assert.That(mechanism.ChooseFreedoms().Select(i => mechanism.Coordinates[i].Name), Is.EqualTo(names));

        var solver = new PositionSolver(mechanism);
        MechanismState state = mechanism.NewState();
        foreach (double turn in new[] { 0.0, 20, 75, 120, -35, 0 })
        {
            double[] values = [20, -15, turn];
            DriveResult result = solver.Drive(state, names.Select((name, i) => new CoordinateTarget(mechanism.CoordinateNamed(name), values[i])).ToArray());
            Assert.That(result.Converged, Is.True, $"{turn}: {result}");
            Assert.That(state["A.angularX"], Is.EqualTo(2 * turn).Within(1e-9));
            Assert.That(names.Select(name => state[name]), Is.EqualTo(values).Within(1e-9));
        }
    }

    [Test]
    public void ShortName_WhereTheCadTellsOne_IsTheCads()
    {
        Mechanism mechanism = Mechanism.Load(Lever);
        Assert.That(mechanism.ChooseFreedoms().Select(i => mechanism.Coordinates[i].ShortName).Single(), Is.EqualTo("Shaft"));
    }

    // Crank and slide are asked of one state that never stops, and of another that is written and read at every step.
    [Test]
    public void Numbers_ReadByAnotherState_GiveTheSameBits()
    {
        Mechanism mechanism = Mechanism.Load(Lever);
        int shaft = mechanism.CoordinateNamed("Shaft");
        MechanismState straight = mechanism.NewState();
        MechanismState kept = mechanism.NewState();
        var solver = new PositionSolver(mechanism);
        var other = new PositionSolver(mechanism);
        var numbers = new double[kept.NumberCount];
        for (int i = 1; i <= 150; i++)
        {
            solver.Drive(straight, shaft, 7.3 * i);
            MechanismState read = mechanism.NewState();
            kept.CopyTo(numbers);
            read.CopyFrom(numbers);
            other.Drive(read, shaft, 7.3 * i);
            kept = read;
            for (int c = 0; c < mechanism.Coordinates.Count; c++)
                Assert.That(BitConverter.DoubleToInt64Bits(kept.Coordinate(c)), Is.EqualTo(BitConverter.DoubleToInt64Bits(straight.Coordinate(c))), $"step {i}");
        }
    }

    [Test]
    public void Numbers_ThatAreNoState_ChangeNothing()
    {
        Mechanism mechanism = Mechanism.Load(Lever);
        MechanismState state = mechanism.NewState();
        new PositionSolver(mechanism).Drive(state, "Shaft", 40);
        var before = new double[state.NumberCount];
        state.CopyTo(before);
        double[] notFinite = (double[])before.Clone();
        notFinite[^2] = double.NaN;
        double[] noRotation = (double[])before.Clone();
        noRotation[3] += 1;
        foreach (double[] wrong in new[] { notFinite, noRotation, [], before[..^1] })
            Assert.That(() => state.CopyFrom(wrong), Throws.ArgumentException);
        Assert.That(() => state.CopyTo(new double[3]), Throws.ArgumentException);
        var after = new double[state.NumberCount];
        state.CopyTo(after);
        Assert.That(after, Is.EqualTo(before));
    }

    private static readonly string Lever = Path.Combine(Dynamics.Scenario.Folder, "..", "..", "csharp", "examples", "LeverTests", "lever.kinefab");

    private static IEnumerable<TestCaseData> Files() =>
        Directory.EnumerateFiles(ExportedMechanism.Fixtures, "*.kinefab", SearchOption.AllDirectories).Order(StringComparer.Ordinal)
            .Select(file => new TestCaseData(file).SetArgDisplayNames(Path.GetFileNameWithoutExtension(file)));

    private static TestCaseData Case(string name, Func<Mechanism> make, int expected) => new TestCaseData(make, expected).SetArgDisplayNames(name);
}
