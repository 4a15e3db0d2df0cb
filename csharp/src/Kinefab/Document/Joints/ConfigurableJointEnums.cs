namespace Kinefab.Document;

/// <summary>What one freedom of a <see cref="ConfigurableJoint"/> may do; values are Unity's and PhysX's.</summary>
[Words]
public enum ConfigurableJointMotion
{
    /// <summary>Nothing.</summary>
    Locked,

    /// <summary>Move within its limit.</summary>
    Limited,

    /// <summary>Move freely.</summary>
    Free,
}

/// <summary>Which drives turn a <see cref="ConfigurableJoint"/>.</summary>
[Words]
public enum RotationDriveMode
{
    /// <summary>angularXDrive and angularYZDrive.</summary>
    XYAndZ,

    /// <summary>slerpDrive.</summary>
    Slerp,
}

/// <summary>Whether PhysX snaps a joint that came apart.</summary>
[Words]
public enum JointProjectionMode
{
    /// <summary>Never.</summary>
    None,

    /// <summary>Past projectionDistance or projectionAngle.</summary>
    PositionAndRotation,
}
