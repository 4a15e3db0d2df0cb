namespace Kinefab.Document;

/// <summary>SoftJointLimit of a <see cref="ConfigurableJoint"/>.</summary>
public sealed partial record SoftJointLimit : DocumentObject
{
    /// <summary>Unity's defaults.</summary>
    public static SoftJointLimit Default { get; } = new();

    /// <summary>Metres or degrees.</summary>
    public double Limit { get; init; }

    /// <summary>Share of the speed kept at the limit, 0 to 1.</summary>
    public double Bounciness { get; init; }

    /// <summary>Distance from the limit within which it is looked at, metres or degrees; 0: PhysX's choice.</summary>
    public double ContactDistance { get; init; }

    private protected override string Describe() => Line($"limit {Limit} m or deg{(Bounciness > 0 ? Line($", bounciness {Bounciness}") : "")}");
}
