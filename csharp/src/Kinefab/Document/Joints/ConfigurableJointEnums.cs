using Kinefab.Json;

namespace Kinefab.Document;

/// <summary>What one freedom of a <see cref="ConfigurableJoint"/> may do; values are Unity's and PhysX's.</summary>
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
public enum RotationDriveMode
{
    /// <summary>angularXDrive and angularYZDrive.</summary>
    XYAndZ,

    /// <summary>slerpDrive.</summary>
    Slerp,
}

/// <summary>Whether PhysX snaps a joint that came apart.</summary>
public enum JointProjectionMode
{
    /// <summary>Never.</summary>
    None,

    /// <summary>Past projectionDistance or projectionAngle.</summary>
    PositionAndRotation,
}

/// <summary>The words of the scene file for <see cref="ConfigurableJointMotion"/>.</summary>
internal static class ConfigurableJointMotionWords
{
    internal static readonly Words<ConfigurableJointMotion> Table = new(
        ("Locked", ConfigurableJointMotion.Locked),
        ("Limited", ConfigurableJointMotion.Limited),
        ("Free", ConfigurableJointMotion.Free));
}

/// <summary>The words of the scene file for <see cref="RotationDriveMode"/>.</summary>
internal static class RotationDriveModeWords
{
    internal static readonly Words<RotationDriveMode> Table = new(
        ("XYAndZ", RotationDriveMode.XYAndZ),
        ("Slerp", RotationDriveMode.Slerp));
}

/// <summary>The words of the scene file for <see cref="JointProjectionMode"/>.</summary>
internal static class JointProjectionModeWords
{
    internal static readonly Words<JointProjectionMode> Table = new(
        ("None", JointProjectionMode.None),
        ("PositionAndRotation", JointProjectionMode.PositionAndRotation));
}
