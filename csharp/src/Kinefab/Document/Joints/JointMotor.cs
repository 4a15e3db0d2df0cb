using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>JointMotor of a <see cref="HingeJoint"/>.</summary>
public sealed record JointMotor : DocumentObject
{
    internal static readonly FieldNames Fields = new([], "targetVelocity", "force", "freeSpin", "extras");

    /// <summary>Unity's defaults.</summary>
    public JointMotor()
    {
    }

    internal JointMotor(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "targetVelocity":
                    TargetVelocity = json.Number();
                    break;
                case "force":
                    Force = json.Number();
                    break;
                case "freeSpin":
                    FreeSpin = json.Boolean();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Unity's defaults.</summary>
    public static JointMotor Default { get; } = new();

    /// <summary>Degrees per second.</summary>
    public double TargetVelocity { get; init; }

    /// <summary>Largest torque, N m; 0 switches the motor off.</summary>
    public double Force { get; init; }

    /// <summary>Only accelerates, never brakes.</summary>
    public bool FreeSpin { get; init; }

    private protected override string Describe() => Line($"motor to {TargetVelocity} deg/s with at most {Force} N m{(FreeSpin ? ", free spin" : "")}");
}
