using System;
using Kinefab.Joints;

namespace Kinefab.Dynamics.Rattle;

/// <summary>The range of a hinge's turn about X, of either kind of joint.</summary>
internal static class HingeRange
{
    /// <summary>Both ends, radians.</summary>
    public static ref readonly AngularLimit Of(JointModel joint) => ref joint is RevoluteJoint hinge ? ref hinge.Limit : ref ((D6Joint)joint).TwistLimit;

    /// <summary>What is left of the way to the nearer end, radians; below 0 beyond it.</summary>
    public static double LeftOf(JointModel joint, double turn)
    {
        ref readonly AngularLimit limit = ref Of(joint);
        return Math.Min(turn - limit.Lower, limit.Upper - turn);
    }
}
