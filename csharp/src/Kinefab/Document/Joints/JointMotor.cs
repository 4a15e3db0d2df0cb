namespace Kinefab.Document;

/// <summary>JointMotor of a <see cref="HingeJoint"/>.</summary>
public sealed partial record JointMotor : DocumentObject
{
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
