namespace Kinefab.Document;

/// <summary>JointDrive: force = positionSpring * (target - position) + positionDamper * (target velocity - velocity).</summary>
public sealed partial record JointDrive : DocumentObject
{
    /// <summary>Unity's defaults: a drive that does nothing.</summary>
    public static JointDrive Default { get; } = new();

    /// <summary>N/m or N m/rad (per kg or kg m^2 with <see cref="UseAcceleration"/>).</summary>
    public double PositionSpring { get; init; }

    /// <summary>N s/m or N m s/rad (per kg or kg m^2 with <see cref="UseAcceleration"/>).</summary>
    public double PositionDamper { get; init; }

    /// <summary>N or N m; infinite: unlimited.</summary>
    public double MaximumForce { get; init; } = double.PositiveInfinity;

    /// <summary>Spring and damper give accelerations instead of forces.</summary>
    public bool UseAcceleration { get; init; }

    /// <summary>Whether it pulls or brakes at all.</summary>
    internal bool IsActive => MaximumForce > 0 && (PositionSpring > 0 || PositionDamper > 0);

    private protected override string Describe() => Line($"drive with spring {PositionSpring}, damper {PositionDamper}, at most {MaximumForce}{(UseAcceleration ? ", as acceleration" : "")}");
}
