using System.Linq;
using Kinefab.Kinematics;

namespace Kinefab.Cli.Motion;

/// <summary>A sweep as a trajectory.</summary>
internal static class SweepTrajectory
{
    internal static Trajectory Of(Mechanism mechanism, SweepResult sweep)
    {
        var trajectory = new Trajectory("position") { Driver = TrajectoryCoordinate.Of(mechanism, sweep.Coordinate) };
        trajectory.At.AddRange(sweep.Values);
        for (int i = 0; i < mechanism.Coordinates.Count; i++)
        {
            TrajectoryCoordinate coordinate = TrajectoryCoordinate.Of(mechanism, i);
            coordinate.Values.AddRange(sweep.States.Select(s => s.Coordinate(i)));
            trajectory.Coordinates.Add(coordinate);
        }

        for (int i = 0; i < mechanism.Scene.Document.GameObjects.Count; i++)
        {
            if (mechanism.Scene.Body(i) is null)
                continue;
            var body = new TrajectoryBody(i, mechanism.Scene.Document.GameObjects[i].Id);
            body.Poses.AddRange(sweep.States.Select(s => s.Pose(i)));
            trajectory.Bodies.Add(body);
        }

        return trajectory;
    }
}
