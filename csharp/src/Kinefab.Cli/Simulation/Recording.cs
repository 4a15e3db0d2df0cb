using System.Linq;
using Kinefab.Cli.Motion;
using Kinefab.Dynamics;

namespace Kinefab.Cli.Simulation;

/// <summary>The poses of all bodies' objects after every step, world frame.</summary>
internal sealed class Recording
{
    private readonly World world;

    internal Recording(World world, SolverKind solver, double step)
    {
        this.world = world;
        Trajectory = new Trajectory(solver.ToString().ToLowerInvariant()) { Step = step };
        Trajectory.Bodies.AddRange(world.Bodies.Select(b => new TrajectoryBody(b.GameObject, b.Id)));
        Note();
    }

    internal Trajectory Trajectory { get; }

    /// <summary>Takes down where everything is.</summary>
    internal void Note()
    {
        Trajectory.At.Add(world.Time);
        for (int i = 0; i < world.Bodies.Count; i++)
            Trajectory.Bodies[i].Poses.Add(world.Bodies[i].Pose);
    }
}
