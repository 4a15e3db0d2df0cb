using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>What a scalar row is as a limit: whether it is reached, left and struck within a step, and how far it may stand passed.</summary>
internal struct LimitEvent
{
    /// <summary>
    /// C up to which a limit may stand passed, not above 0: where it stood when closing the pose had failed, as limits that contradict each
    /// other or the rest of the joints leave it. It is passed no further, and comes back as far as the others let it.
    /// </summary>
    public double Allowed;

    /// <summary>Time since the joint left its limit, as far as it was in this part of a step; else infinite, s.</summary>
    public double Flight;

    /// <summary>J of body 0's place where the joint last stood at its limit: of a slide's one limit it tells its two ends apart.</summary>
    public Vector3d LeftAlong;

    /// <summary>
    /// Whether a limit is not reached at the start of the step, or has no row there, as in the middle of a cone: the drift is not held by it,
    /// and where it reaches it, see Substep, the joint strikes.
    /// </summary>
    public bool IsApart;

    /// <summary>Whether a limit that is reached at the start of the drift is left in it and passed at its end: it is apart until this piece has ended.</summary>
    public bool IsLeft;

    /// <summary>Whether a limit that every drift passes is held from its start on: see <see cref="ActiveSet{V}.HoldBack"/>.</summary>
    public bool IsHeldBack;

    /// <summary>Whether a limit was let go in this drift, as its impulse drew.</summary>
    public bool HasDrawn;
}
