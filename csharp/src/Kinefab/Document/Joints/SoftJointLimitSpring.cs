namespace Kinefab.Document;

/// <summary>SoftJointLimitSpring; both 0 makes the limit hard.</summary>
public sealed partial record SoftJointLimitSpring : DocumentObject
{
    /// <summary>Unity's defaults.</summary>
    public static SoftJointLimitSpring Default { get; } = new();

    /// <summary>N/m or N m/rad.</summary>
    public double Spring { get; init; }

    /// <summary>N s/m or N m s/rad.</summary>
    public double Damper { get; init; }

    private protected override string Describe() => Line($"limit spring {Spring}, damper {Damper}");
}
