using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;

namespace Kinefab.Cli.Motion;

/// <summary>A recorded motion as schemas/trajectory.schema.json has it: over time or over a driven coordinate, in Unity's frame.</summary>
internal sealed class Trajectory
{
    internal Trajectory(string solver) => Solver = solver;

    /// <summary>unity, exact or position.</summary>
    internal string Solver { get; }

    /// <summary>Seconds between two steps; null for a sweep.</summary>
    internal double? Step { get; init; }

    /// <summary>The driven coordinate of a sweep; its values stand in <see cref="At"/>. Null over time.</summary>
    internal TrajectoryCoordinate? Driver { get; init; }

    /// <summary>Seconds, or values of the driver.</summary>
    internal List<double> At { get; } = [];

    /// <summary>Joint coordinates, each with one value for each entry of <see cref="At"/>.</summary>
    internal List<TrajectoryCoordinate> Coordinates { get; } = [];

    /// <summary>World poses of the objects that carry Rigidbodies.</summary>
    internal List<TrajectoryBody> Bodies { get; } = [];
}

/// <summary>A joint coordinate over a trajectory, degrees or metres.</summary>
internal sealed record TrajectoryCoordinate(int GameObject, string Id, int Component, Coordinate Coordinate, string Name)
{
    internal static TrajectoryCoordinate Of(Mechanism mechanism, int index)
    {
        MechanismCoordinate source = mechanism.Coordinates[index];
        return new TrajectoryCoordinate(
            source.GameObject, mechanism.Scene.Document.GameObjects[source.GameObject].Id, source.Component, source.Coordinate, source.Name);
    }

    internal List<double> Values { get; } = [];
}

/// <summary>An object over a trajectory.</summary>
internal sealed record TrajectoryBody(int GameObject, string Id)
{
    internal List<Pose> Poses { get; } = [];
}
