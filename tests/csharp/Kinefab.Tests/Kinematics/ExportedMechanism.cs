using System;
using System.IO;
using System.Linq;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Tests.Conformance;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>
/// A scene that the exporter made of a mechanism under fixtures, driven, and read back in its source's right-handed frame:
/// the sources are Y-up, so only x is mirrored.
/// </summary>
internal sealed class ExportedMechanism
{
    public static readonly string Fixtures = Path.Combine(ConformanceCases.Folder, "..", "..", "fixtures");

    public ExportedMechanism(string name)
    {
        Scene = Load(Path.Combine(Fixtures, "mechanisms", name + ".kinefab"));
        Mechanism = Mechanism.Create(Scene);
        State = Mechanism.NewState();
        Solver = new PositionSolver(Mechanism);
    }

    public ValidScene Scene { get; }

    public Mechanism Mechanism { get; }

    public MechanismState State { get; }

    public PositionSolver Solver { get; }

    /// <summary>Worst distance and angle left open by the last drive, metres and radians.</summary>
    public double Open { get; private set; }

    public static ValidScene Load(string path)
    {
        SceneDocument document = SceneFile.Load(path).Document ?? throw new InvalidOperationException(path);
        return SceneValidator.Validate(document).Scene ?? throw new InvalidOperationException(path);
    }

    /// <summary>Turns a part's hinge until the part stands at an angle about z.</summary>
    public void Turn(string part, double degrees) => Drive(part, Coordinate.Angle, degrees - Angle(part));

    public void Drive(string part, Coordinate coordinate, double value) => Drive((part, coordinate, value));

    public void Drive(params (string Part, Coordinate Coordinate, double Value)[] drives)
    {
        CoordinateTarget[] targets = drives.Select(d => new CoordinateTarget(Find(d.Part, d.Coordinate), d.Value)).ToArray();
        DriveResult result = Solver.Drive(State, targets);
        Assert.That(result.Converged, Is.True, $"{result.Status} at {result.Fraction}");
        Open = Math.Max(result.ErrorMetres, result.ErrorDegrees * Math.PI / 180);
    }

    public double Value(string part, Coordinate coordinate) => State.Coordinate(Find(part, coordinate));

    public (RangeLimit Low, RangeLimit High) Range(string part, Coordinate coordinate = Coordinate.Angle) =>
        new Sweep(Solver).Range(State, Find(part, coordinate));

    public SweepResult Sweep(string part, double to, int steps) => new Sweep(Solver).Run(State, Find(part, Coordinate.Angle), 0, to, steps);

    public Vector3d Position(string part) => Mirror(State.Pose(part).Position);

    /// <summary>An axis of a part's own frame, in the source's world.</summary>
    public Vector3d Axis(string part, Vector3d axis) => Mirror(State.Pose(part).Rotation * Mirror(axis));

    /// <summary>Angle of a part's x axis in the plane, degrees.</summary>
    public double Angle(string part)
    {
        Vector3d x = Axis(part, Vector3d.UnitX);
        return Math.Atan2(x.Y, x.X) * (180 / Math.PI);
    }

    /// <summary>The part's first such coordinate.</summary>
    public int Find(string part, Coordinate coordinate) => Enumerable.Range(0, Mechanism.Coordinates.Count).First(i =>
        Mechanism.Coordinates[i].GameObject == Mechanism.GameObjectNamed(part) && Mechanism.Coordinates[i].Coordinate == coordinate);

    private static Vector3d Mirror(Vector3d v) => new(-v.X, v.Y, v.Z);
}
