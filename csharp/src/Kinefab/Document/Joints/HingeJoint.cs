using System;

namespace Kinefab.Document;

/// <summary>
/// HingeJoint: one rotation about <see cref="AnchoredJoint.Axis"/>; removes five freedoms.  The angle is that of
/// the own body against the connected one, by the left-hand rule about the axis, zero at start-up.
/// </summary>
public sealed partial record HingeJoint : AnchoredJoint
{
    /// <summary>Whether <see cref="Spring"/> acts (unless <see cref="UseMotor"/> is on).</summary>
    public bool UseSpring { get; init; }

    /// <summary>Spring towards an angle.</summary>
    public JointSpring Spring { get; init; } = JointSpring.Default;

    /// <summary>Whether <see cref="Motor"/> acts.</summary>
    public bool UseMotor { get; init; }

    /// <summary>Drive towards an angular velocity.</summary>
    public JointMotor Motor { get; init; } = JointMotor.Default;

    /// <summary>Whether <see cref="Limits"/> act.</summary>
    public bool UseLimits { get; init; }

    /// <summary>Range of the angle.</summary>
    public JointLimits Limits { get; init; } = JointLimits.Default;

    /// <summary>Limits range over -360..360 degrees instead of -180..180.</summary>
    public bool ExtendedLimits { get; init; }

    /// <summary>The spring gives an angular acceleration instead of a torque.</summary>
    public bool UseAcceleration { get; init; }

    /// <summary>A limit as Unity takes it, which cuts what is beyond half a turn, or a whole one where the limits are extended (ScriptReference, HingeJoint.limits).</summary>
    internal double Cut(double limit) => Math.Max(ExtendedLimits ? -360 : -180, Math.Min(ExtendedLimits ? 360 : 180, limit));

    private protected override string Describe() => $"HingeJoint {Ends}{(UseLimits ? $", {Limits}" : "")}{(UseMotor ? $", {Motor}" : UseSpring ? $", {Spring}" : "")}";
}
