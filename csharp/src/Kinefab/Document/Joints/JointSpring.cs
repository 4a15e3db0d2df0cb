namespace Kinefab.Document;

/// <summary>JointSpring of a <see cref="HingeJoint"/>.</summary>
public sealed partial record JointSpring : DocumentObject
{
    /// <summary>Unity's defaults.</summary>
    public static JointSpring Default { get; } = new();

    /// <summary>N m/rad.</summary>
    public double Spring { get; init; }

    /// <summary>N m s/rad.</summary>
    public double Damper { get; init; }

    /// <summary>Degrees.</summary>
    public double TargetPosition { get; init; }

    private protected override string Describe() => Line($"spring to {TargetPosition} deg, spring {Spring}, damper {Damper}");
}
