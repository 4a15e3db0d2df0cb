using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics;

/// <summary>Bodies, joints and couplings in PhysX's terms: all that a solver needs. The arrays never change length.</summary>
internal sealed class MultibodySystem
{
    private readonly JointReaction[] _reactions;

    public readonly Bodies Bodies;

    /// <summary>In the order of their creation, which decides the order in which PGS solves them.</summary>
    public readonly JointModel[] Joints;
    public readonly CoordinateCoupling[] Couplings;

    /// <summary>m/s^2.</summary>
    public Vector3d Gravity = new(0, -9.81, 0);

    /// <summary>How many threads a step may use.</summary>
    public int Threads = 1;

    /// <summary>Ends a step early, amid what it writes; set for a step that can be undone, see <see cref="World.Step"/>.</summary>
    public CancellationToken Cancellation;

    /// <summary>Writes the last step's reactions; set by a solver that leaves this until they are read.</summary>
    public Action<JointReaction[]>? UnreadReactions;

    /// <summary>Times that motion was stopped: a body's that left the range of numbers, or an island's in a part of a step without solution; counted by the solver.</summary>
    public int Stops;

    /// <summary>Joints times parts of steps that were tried beyond the plain ones, of all steps so far; counted by the exact solver.</summary>
    public double SubstepWork;

    /// <summary>Islands of which the last step could not be solved in whole; written by the exact solver.</summary>
    public readonly List<UnsolvedStep> Unsolved = new();

    /// <summary>Islands of which the last step found the joints apart and moved the bodies together; written by the exact solver.</summary>
    public readonly List<ClosedPose> Closed = new();

    /// <summary>Islands of which the last step took speeds off that their joints forbid; written by the exact solver.</summary>
    public readonly List<ForbiddenSpeed> ForbiddenSpeeds = new();

    /// <summary>Limits that stood passed in the last step, since no pose satisfies them and the rest of the joints.</summary>
    public readonly List<HeldLimit> HeldLimits = new();

    /// <summary>Drives without limit of force that the last step could not move as asked, and the limits that they push against.</summary>
    public readonly List<StalledJoint> StalledJoints = new();

    public MultibodySystem(Bodies bodies, JointModel[] joints, CoordinateCoupling[] couplings)
    {
        Bodies = bodies;
        Joints = joints;
        Couplings = couplings;
        _reactions = new JointReaction[joints.Length];
    }

    /// <summary>What each joint's constraint (locked axes and limits) did to actor 0 in the last step; written by the solver.</summary>
    public JointReaction[] Reactions
    {
        get
        {
            UnreadReactions?.Invoke(_reactions);
            UnreadReactions = null;
            return _reactions;
        }
    }

    /// <summary>Set when what a body is made of has changed, until the solver has taken note of it.</summary>
    public bool HasChangedBodies;

    /// <summary>Whether a program gave bodies other angular velocities since the last step: who counts turns by those he noted notes them again.</summary>
    public bool HasChangedSpeeds;

    /// <summary>All that a program or a step may change, but for what the solver remembers.</summary>
    public void Exchange(StateTape tape)
    {
        JointReaction[] reactions = Reactions;
        Bodies.Exchange(tape);
        foreach (JointModel joint in Joints)
        {
            JointModel copy = tape.IsPlaying ? joint : joint.Between(joint.Body0, joint.Body1);
            tape.Value(ref copy);
            if (tape.IsPlaying)
                joint.TakeOver(copy);
        }

        foreach (CoordinateCoupling coupling in Couplings)
        {
            tape.Array(coupling.Last);
            tape.Value(ref coupling.Offset);
        }

        tape.Array(reactions);
        tape.Value(ref Gravity);
        tape.Value(ref Stops);
        tape.Value(ref HasChangedBodies);
        tape.Value(ref HasChangedSpeeds);
    }

    /// <summary>Before a step that does not write this one any more.</summary>
    public void ClearReaction(int joint) => _reactions[joint] = default;
}

/// <summary>Force and torque of a joint's constraint on actor 0, world frame; the torque is about the joint's anchor in actor 1.</summary>
internal struct JointReaction
{
    /// <summary>N.</summary>
    public Vector3d Force;

    /// <summary>N m.</summary>
    public Vector3d Torque;
}

/// <summary>An island that stood still in a part of a step.</summary>
internal struct UnsolvedStep
{
    /// <summary>One of the island's bodies.</summary>
    public int Body;

    /// <summary>The joint that was farthest from closed, or null when all closed and energy came from nothing.</summary>
    public JointModel? Joint;

    /// <summary>By how much, m or rad; infinite when it was no number.</summary>
    public double Error;
    public bool IsAngular;

    /// <summary>What may be to blame, of the pose where that part began.</summary>
    public StepTroubles Troubles;
}

/// <summary>What was the case where a part of a step began that could not be solved.</summary>
[Flags]
internal enum StepTroubles : byte
{
    None = 0,

    /// <summary>Joints stood open.</summary>
    Open = 1,

    /// <summary>A hard limit was reached.</summary>
    Limit = 2,

    /// <summary>A motor or drive without a limit of its force was at work.</summary>
    EndlessDrive = 4,
}

/// <summary>An island whose bodies were moved to close its joints.</summary>
internal struct ClosedPose
{
    /// <summary>One of the island's bodies.</summary>
    public int Body;

    /// <summary>The joint that stood farthest open.</summary>
    public JointModel? Joint;

    /// <summary>By how much, m or rad.</summary>
    public double Error;
    public bool IsAngular;

    /// <summary>The farthest that a body's centre of mass was moved, m, and a body turned, rad.</summary>
    public double Distance;
    public double Angle;
}

/// <summary>An island that began with speeds that its joints forbid.</summary>
internal struct ForbiddenSpeed
{
    /// <summary>One of the island's bodies.</summary>
    public int Body;

    /// <summary>The joint with the largest.</summary>
    public JointModel? Joint;

    /// <summary>m/s or rad/s.</summary>
    public double Speed;
    public bool IsAngular;
}

/// <summary>A limit that stands passed.</summary>
internal struct HeldLimit
{
    /// <summary>One of the island's bodies, the same for all of its limits.</summary>
    public int Body;

    public JointModel Joint;

    /// <summary>By how much, m or rad; of a twist times the cosine of half the swing.</summary>
    public double Error;
    public bool IsAngular;
}

/// <summary>A joint of an island in which drives without limit of force stall.</summary>
internal struct StalledJoint
{
    /// <summary>One of the island's bodies, the same for all of its joints.</summary>
    public int Body;

    public JointModel Joint;

    /// <summary>Whether its drive stalls; else a drive pushes against its limit.</summary>
    public bool IsDrive;
}

/// <summary>Moves a mechanism forward in time. Allocates nothing after its first step.</summary>
internal interface ISolver
{
    /// <summary>One step of dt seconds; forces and torques are used up by it.</summary>
    void Step(double dt);

    /// <summary>What the next step takes from those before it, beside the mechanism itself, which has been passed already.</summary>
    void Exchange(StateTape tape);
}
