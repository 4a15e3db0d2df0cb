using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>
/// HingeJoint: one rotation about <see cref="AnchoredJoint.Axis"/>; removes five freedoms.  The angle is that of
/// the own body against the connected one, by the left-hand rule about the axis, zero at start-up.
/// </summary>
public sealed record HingeJoint : AnchoredJoint
{
    internal static readonly FieldNames Fields = new(
        ["type"],
        [
            .. AnchoredJointFields,
            "useSpring", "spring", "useMotor", "motor", "useLimits", "limits", "extendedLimits",
            "useAcceleration", "extras",
        ]);

    /// <summary>Unity's defaults.</summary>
    public HingeJoint()
    {
    }

    internal HingeJoint(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "useSpring":
                    UseSpring = json.Boolean();
                    break;
                case "spring":
                    Spring = new JointSpring(ref json);
                    break;
                case "useMotor":
                    UseMotor = json.Boolean();
                    break;
                case "motor":
                    Motor = new JointMotor(ref json);
                    break;
                case "useLimits":
                    UseLimits = json.Boolean();
                    break;
                case "limits":
                    Limits = new JointLimits(ref json);
                    break;
                case "extendedLimits":
                    ExtendedLimits = json.Boolean();
                    break;
                case "useAcceleration":
                    UseAcceleration = json.Boolean();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
                default:
                    ReadAnchoredJointField(ref json, fields.Name);
                    break;
            }
        }
    }

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

    private protected override string Describe() => $"HingeJoint {Ends}{(UseLimits ? $", {Limits}" : "")}{(UseMotor ? $", {Motor}" : UseSpring ? $", {Spring}" : "")}";
}
