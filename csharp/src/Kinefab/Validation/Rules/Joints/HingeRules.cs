using System;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;

namespace Kinefab.Validation;

/// <summary>HingeJoints.</summary>
internal static class HingeRules
{
    internal static void Numbers(HingeJoint hinge, in Place at)
    {
        NumberRules.NotNegative(at, "spring/spring", hinge.Spring.Spring);
        NumberRules.NotNegative(at, "spring/damper", hinge.Spring.Damper);
        NumberRules.Finite(at, "spring/targetPosition", hinge.Spring.TargetPosition);
        NumberRules.Finite(at, "motor/targetVelocity", hinge.Motor.TargetVelocity);
        NumberRules.NotNegative(at, "motor/force", hinge.Motor.Force);
        NumberRules.Finite(at, "limits/min", hinge.Limits.Min);
        NumberRules.Finite(at, "limits/max", hinge.Limits.Max);
        NumberRules.Share(at, "limits/bounciness", hinge.Limits.Bounciness);
        NumberRules.NotNegative(at, "limits/bounceMinVelocity", hinge.Limits.BounceMinVelocity);
        NumberRules.NotNegative(at, "limits/contactDistance", hinge.Limits.ContactDistance);
    }

    internal static void LimitsOrder(HingeJoint hinge, in Place at)
    {
        if (hinge.Limits.Min > hinge.Limits.Max)
        {
            at.Report(
                "limits",
                DiagnosticCodes.HingeLimitsOrder,
                ("min", Invariant.Text(hinge.Limits.Min)),
                ("max", Invariant.Text(hinge.Limits.Max)));
        }
    }

    /// <summary>PhysX takes min >= max for "locked at 0", whatever the two are.</summary>
    internal static void LimitsEqual(HingeJoint hinge, in Place at)
    {
        if (hinge.UseLimits && hinge.Limits.Min == hinge.Limits.Max)
            at.Report("limits", DiagnosticCodes.HingeLimitsEqual, ("angle", Invariant.Text(hinge.Limits.Min)));
    }

    /// <summary>Unity measures the angle within a half turn each way, with extendedLimits within a whole one.</summary>
    internal static void LimitsRange(HingeJoint hinge, in Place at)
    {
        if (!hinge.UseLimits)
            return;
        double furthest = Math.Max(Math.Abs(hinge.Limits.Min), Math.Abs(hinge.Limits.Max));
        if (furthest > 360)
            at.Report("limits", DiagnosticCodes.HingeLimitsBeyond360, ("angle", Invariant.Text(furthest)));
        else if (furthest > 180 && !hinge.ExtendedLimits)
            at.Report("limits", DiagnosticCodes.HingeLimitsBeyond180, ("angle", Invariant.Text(furthest)));
    }

    /// <summary>useMotor switches the spring off.</summary>
    internal static void MotorAndSpring(HingeJoint hinge, in Place at)
    {
        if (hinge.UseMotor && hinge.UseSpring)
            at.Report("useSpring", DiagnosticCodes.HingeMotorOverridesSpring);
    }

    /// <summary>A motor of no force is off.</summary>
    internal static void MotorForce(HingeJoint hinge, in Place at)
    {
        if (hinge.UseMotor && hinge.Motor.Force == 0)
            at.Report("motor/force", DiagnosticCodes.HingeMotorForceZero);
    }
}
