using System.Collections.Generic;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Islands that are stepped one after the other or, being of one shape, side by side. What is found on the way stays with the group until
/// it is asked for, since groups may be stepped by several threads.
/// </summary>
internal abstract class IslandGroup
{
    private readonly List<ClosedPose> _closed = new();
    private readonly List<ForbiddenSpeed> _forbidden = new();
    private readonly List<UnsolvedStep> _unsolved = new();
    private readonly List<HeldLimit> _held = new();
    private readonly List<StalledJoint> _stalled = new();
    private int _stops;
    private double _substepWork;

    /// <param name="islands">With all of their rows.</param>
    protected IslandGroup(Island[] islands) => Islands = islands;

    /// <summary>The islands with all of their rows.</summary>
    public Island[] Islands { get; }

    /// <summary>One step of all islands.</summary>
    /// <param name="dt">Step, s.</param>
    /// <param name="tolerance">Largest C, metres or radians.</param>
    /// <param name="areReactionsAwaited">Whether a joint could break, so that what they did is to be known at once.</param>
    public abstract void Step(double dt, double tolerance, bool areReactionsAwaited);

    /// <summary>What joints did in the last step, where the step has not written it.</summary>
    public virtual void WriteReactions(JointReaction[] reactions)
    {
    }

    /// <summary>What the next step takes from those before it.</summary>
    public abstract void Exchange(StateTape tape);

    /// <summary>The same of one island, for a group in which it has another place.</summary>
    /// <param name="tape">Takes it down, or has it.</param>
    /// <param name="island">Index in <see cref="Islands"/>.</param>
    public abstract void Exchange(StateTape tape, int island);

    /// <summary>Tells the mechanism what the last step had to say, and forgets it.</summary>
    public void Report(MultibodySystem mechanism)
    {
        mechanism.Stops += _stops;
        mechanism.SubstepWork += _substepWork;
        _stops = 0;
        _substepWork = 0;
        Move(_closed, mechanism.Closed);
        Move(_forbidden, mechanism.ForbiddenSpeeds);
        Move(_unsolved, mechanism.Unsolved);
        Move(_held, mechanism.HeldLimits);
        Move(_stalled, mechanism.StalledJoints);
    }

    /// <summary>Takes down what a step controller's last step has to say of an island.</summary>
    /// <param name="controller">The one that made the step.</param>
    /// <param name="island">The island that was stepped.</param>
    /// <param name="stopsBefore">The step controller's stops before the step.</param>
    protected void Note(StepController controller, Island island, int stopsBefore)
    {
        _substepWork += (controller.Tries - 1.0) * island.Blocks.Length;
        if (controller.HasClosed)
        {
            _closed.Add(controller.Closed(island));
        }

        if (controller.HasForbiddenSpeed)
        {
            _forbidden.Add(controller.Forbidden(island));
        }

        if (controller.DampedSteps > stopsBefore)
        {
            _stops += controller.DampedSteps - stopsBefore;
            _unsolved.Add(controller.Unsolved(island));
        }

        controller.AddHeldLimits(island, _held);
        controller.AddStalled(island, _stalled);
    }

    private static void Move<T>(List<T> from, List<T> to)
    {
        for (int i = 0; i < from.Count; i++)
        {
            to.Add(from[i]);
        }

        from.Clear();
    }
}
