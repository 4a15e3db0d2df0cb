using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework.Constraints;

namespace Kinefab.NUnit;

/// <summary>
/// A scene moves as it was recorded: driven to the same values, or run by the same solver for the same times. A failure
/// names the body that is furthest from its recorded pose, where, and shows the series.
/// </summary>
public sealed class TrajectoryConstraint : Constraint
{
    private readonly string _path;
    private double _tolerance = 1e-6;

    internal TrajectoryConstraint(string path) => _path = path ?? throw new ArgumentNullException(nameof(path));

    /// <inheritdoc/>
    public override string Description => $"every body where {_path} has it within {Figures.Number(_tolerance)} m and radians";

    /// <summary>How far a body may be off, metres and radians; 1e-6 unless stated.</summary>
    /// <param name="tolerance">Metres and radians, not negative.</param>
    /// <returns>This constraint, to go on with.</returns>
    public TrajectoryConstraint Within(double tolerance)
    {
        _tolerance = tolerance >= 0 ? tolerance : throw Figures.Negative(nameof(tolerance), tolerance);
        return this;
    }

    /// <inheritdoc/>
    public override ConstraintResult ApplyTo<TActual>(TActual actual) => FaultyFile.OrResult(this, actual, () => Judge(actual));

    private MechanismResult Judge(object? actual)
    {
        RecordedTrajectory recorded = RecordedTrajectory.Read(_path);
        var ids = Tested.Scene(actual).Document.GameObjects.Select(gameObject => gameObject.Id).ToHashSet(StringComparer.Ordinal);
        IEnumerable<string> moved = recorded.Bodies.Select(body => body.Id);
        if ((recorded.IsDriven ? moved.Prepend(recorded.DriverId) : moved).FirstOrDefault(id => !ids.Contains(id)) is string absent)
            return new MechanismResult(this, actual, isSuccess: false, $"{_path} is of another scene: this one has no {absent}");

        string stop = "";
        IEnumerable<Func<string, Pose>> motion = recorded.IsDriven ? Driven(Tested.Mechanism(actual), recorded, text => stop = text) : Run(Tested.Scene(actual), recorded);
        var rows = new List<string>();
        (double Off, string Text) worst = (0, "");
        int i = 0;
        foreach (Func<string, Pose> poseOf in motion)
        {
            (double off, string text) = Worst(recorded, i, poseOf);
            rows.Add($"{Figures.Number(recorded.At[i])}  {Figures.Number(off)}");
            if (!(off <= worst.Off))
                worst = (off, text);
            i++;
        }

        bool isSuccess = stop.Length == 0 && worst.Off <= _tolerance;
        string found = stop.Length > 0 ? stop : worst.Text;
        string[] lines = [$"{(recorded.IsDriven ? "value" : "time [s]")}  furthest body [m, radians]", .. Figures.Rows(rows.Count).Select(row => rows[row])];
        return new MechanismResult(this, actual, isSuccess, found, lines);
    }

    private static (double Off, string Text) Worst(RecordedTrajectory recorded, int i, Func<string, Pose> poseOf)
    {
        (double Off, string Text) worst = (0, "");
        foreach ((string id, Pose[] poses) in recorded.Bodies)
        {
            Pose pose = poseOf(id);
            double metres = (pose.Position - poses[i].Position).Length;
            double radians = 2 * (pose.Rotation * poses[i].Rotation.Conjugate()).Vector.Length;
            double off = Math.Max(metres, radians);
            if (!(off <= worst.Off))
            {
                worst = (off, string.Create(
                    CultureInfo.InvariantCulture,
                    $"{id} is off by {Figures.Number(metres)} m and {Figures.Number(radians)} radians at {Figures.Number(recorded.At[i])}{(recorded.IsDriven ? "" : " s")}"));
            }
        }

        return worst;
    }

    private static IEnumerable<Func<string, Pose>> Driven(Mechanism mechanism, RecordedTrajectory recorded, Action<string> stop)
    {
        int driver = mechanism.FindCoordinate(mechanism.GameObjectNamed(recorded.DriverId), recorded.DriverComponent, recorded.DriverCoordinate);
        if (driver < 0)
        {
            stop($"{recorded.DriverId}[{recorded.DriverComponent}] has no {recorded.DriverCoordinate} to drive in this scene");
            yield break;
        }

        var solver = new PositionSolver(mechanism);
        MechanismState state = mechanism.NewState();
        foreach (double value in recorded.At)
        {
            if (!solver.Drive(state, driver, value).Converged)
            {
                stop($"{recorded.DriverId} stops at {Figures.Of(mechanism.Coordinates[driver], state.Coordinate(driver))} on the way to {Figures.Number(value)}");
                yield break;
            }

            yield return state.Pose;
        }
    }

    private static IEnumerable<Func<string, Pose>> Run(ValidScene scene, RecordedTrajectory recorded)
    {
        World world = World.Create(scene, recorded.Solver);
        foreach (double time in recorded.At)
        {
            while (world.Time < time - recorded.Step / 2)
                world.Step(recorded.Step);
            yield return id => world.Body(id).Pose;
        }
    }
}
