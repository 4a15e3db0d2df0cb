namespace Kinefab.Document;

/// <summary>Limits and drive of one axis of a link: metres or degrees, newtons or newton metres, gains for each metre or radian.</summary>
public sealed partial record ArticulationDrive : DocumentObject
{
    /// <summary>A drive that does nothing.</summary>
    public static ArticulationDrive Default { get; } = new();

    /// <summary>Metres or degrees.</summary>
    public double LowerLimit { get; init; }

    /// <summary>Metres or degrees.</summary>
    public double UpperLimit { get; init; }

    /// <summary>N/m or N m/rad (per kg or kg m^2 with <see cref="ArticulationDriveType.Acceleration"/>).</summary>
    public double Stiffness { get; init; }

    /// <summary>N s/m or N m s/rad (per kg or kg m^2 with <see cref="ArticulationDriveType.Acceleration"/>).</summary>
    public double Damping { get; init; }

    /// <summary>N or N m; infinite: unlimited.</summary>
    public double ForceLimit { get; init; } = double.PositiveInfinity;

    /// <summary>Metres or degrees.</summary>
    public double Target { get; init; }

    /// <summary>m/s or degrees/s, positive where the coordinate grows.</summary>
    public double TargetVelocity { get; init; }

    /// <summary>Forces, accelerations, or one of the two that are as stiff as can be.</summary>
    public ArticulationDriveType DriveType { get; init; }

    /// <summary>Whether it pulls or brakes at all.</summary>
    internal bool IsActive => ForceLimit > 0 && (DriveType is ArticulationDriveType.Target or ArticulationDriveType.Velocity || Stiffness > 0 || Damping > 0);

    private protected override string Describe() => Line($"{DriveType} drive with stiffness {Stiffness}, damping {Damping}, at most {ForceLimit}, to {Target} at {TargetVelocity}");
}
