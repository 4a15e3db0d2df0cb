namespace Kinefab.Document;

/// <summary>JointLimits of a <see cref="HingeJoint"/>.</summary>
public sealed partial record JointLimits : DocumentObject
{
    /// <summary>Unity's defaults.</summary>
    public static JointLimits Default { get; } = new();

    /// <summary>Degrees.</summary>
    public double Min { get; init; }

    /// <summary>Degrees.</summary>
    public double Max { get; init; }

    /// <summary>Share of the speed kept at the limit, 0 to 1.</summary>
    public double Bounciness { get; init; }

    /// <summary>Slowest approach that bounces, degrees per second.</summary>
    public double BounceMinVelocity { get; init; } = 0.2;

    /// <summary>Distance from the limit within which it is looked at, degrees; 0: PhysX's choice.</summary>
    public double ContactDistance { get; init; }

    private protected override string Describe() => Line($"limits {Min} to {Max} deg{(Bounciness > 0 ? Line($", bounciness {Bounciness}") : "")}");
}
