namespace Kinefab.Document;

/// <summary>How a link may move against the one above it; values are Unity's.</summary>
[Words]
public enum ArticulationJointType
{
    /// <summary>Not at all.</summary>
    Fixed,

    /// <summary>Along X of the anchors.</summary>
    Prismatic,

    /// <summary>About X of the anchors.</summary>
    Revolute,

    /// <summary>About those of X, Y and Z that are not locked.</summary>
    Spherical,
}

/// <summary>What an <see cref="ArticulationDrive"/> gives; values are Unity's.</summary>
[Words]
public enum ArticulationDriveType
{
    /// <summary>Forces: gains in N/m, N s/m or N m/rad, N m s/rad.</summary>
    Force,

    /// <summary>Accelerations: gains per unit of the mass or inertia that the axis sees.</summary>
    Acceleration,

    /// <summary>The target as stiffly as the solver can; gains do not count.</summary>
    Target,

    /// <summary>The target velocity as stiffly as the solver can; gains do not count.</summary>
    Velocity,
}
