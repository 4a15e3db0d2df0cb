using System.Linq;
using Kinefab.Cli.Motion;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Numerics;

namespace Kinefab.Cli.Simulation;

/// <summary>The poses of all bodies' objects and the joint coordinates after every step, world frame.</summary>
internal sealed class Recording
{
    private readonly World world;
    private readonly MechanismState state;
    private readonly int[] gameObjects;
    private readonly Pose[] poses;

    internal Recording(World world, Mechanism mechanism, SolverKind solver, double step)
    {
        this.world = world;
        state = mechanism.NewState();
        gameObjects = world.Bodies.Select(b => b.GameObject).ToArray();
        poses = new Pose[gameObjects.Length];
        Trajectory = new Trajectory(solver.ToString().ToLowerInvariant()) { Step = step };
        Trajectory.Bodies.AddRange(world.Bodies.Select(b => new TrajectoryBody(b.GameObject, b.Id)));
        Trajectory.Coordinates.AddRange(Enumerable.Range(0, mechanism.Coordinates.Count).Select(i => TrajectoryCoordinate.Of(mechanism, i)));
        Note();
    }

    internal Trajectory Trajectory { get; }

    /// <summary>Takes down where everything is.</summary>
    internal void Note()
    {
        Trajectory.At.Add(world.Time);
        for (int i = 0; i < poses.Length; i++)
        {
            poses[i] = world.Bodies[i].Pose;
            Trajectory.Bodies[i].Poses.Add(poses[i]);
        }

        state.SetPoses(gameObjects, poses);
        for (int i = 0; i < Trajectory.Coordinates.Count; i++)
            Trajectory.Coordinates[i].Values.Add(state.Coordinate(i));
    }
}
