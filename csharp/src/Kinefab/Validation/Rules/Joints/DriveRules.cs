using Kinefab.Diagnostics;
using Kinefab.Document;

namespace Kinefab.Validation;

/// <summary>Drives of ConfigurableJoints.</summary>
internal static class DriveRules
{
    internal static void Numbers(ConfigurableJoint joint, in Place at)
    {
        Numbers(joint.XDrive, "xDrive", at);
        Numbers(joint.YDrive, "yDrive", at);
        Numbers(joint.ZDrive, "zDrive", at);
        Numbers(joint.AngularXDrive, "angularXDrive", at);
        Numbers(joint.AngularYZDrive, "angularYZDrive", at);
        Numbers(joint.SlerpDrive, "slerpDrive", at);
    }

    /// <summary>PhysX leaves a Slerp drive out as soon as one angular axis is locked.</summary>
    internal static void SlerpLocked(ConfigurableJoint joint, in Place at)
    {
        bool locked = IsLocked(joint.AngularXMotion) || IsLocked(joint.AngularYMotion) || IsLocked(joint.AngularZMotion);
        if (joint.RotationDriveMode == RotationDriveMode.Slerp && Acts(joint.SlerpDrive) && locked)
            at.Report("slerpDrive", DiagnosticCodes.SlerpDriveLocked);
    }

    /// <summary>The rotation drive mode decides which angular drives act at all.</summary>
    internal static void OtherMode(ConfigurableJoint joint, in Place at)
    {
        if (joint.RotationDriveMode == RotationDriveMode.Slerp)
        {
            Unused(joint.AngularXDrive, "angularXDrive", "Slerp", at);
            Unused(joint.AngularYZDrive, "angularYZDrive", "Slerp", at);
        }
        else
        {
            Unused(joint.SlerpDrive, "slerpDrive", "XYAndZ", at);
        }
    }

    /// <summary>A drive on a locked freedom is left out.</summary>
    internal static void LockedFreedom(ConfigurableJoint joint, in Place at)
    {
        Locked(joint.XDrive, IsLocked(joint.XMotion), "xDrive", at);
        Locked(joint.YDrive, IsLocked(joint.YMotion), "yDrive", at);
        Locked(joint.ZDrive, IsLocked(joint.ZMotion), "zDrive", at);
        if (joint.RotationDriveMode != RotationDriveMode.XYAndZ)
            return;
        Locked(joint.AngularXDrive, IsLocked(joint.AngularXMotion), "angularXDrive", at);
        Locked(joint.AngularYZDrive, IsLocked(joint.AngularYMotion) && IsLocked(joint.AngularZMotion), "angularYZDrive", at);
    }

    /// <summary>A drive that may not push does nothing: what a C# <c>new JointDrive()</c> starts with.</summary>
    internal static void MaximumForceZero(ConfigurableJoint joint, in Place at)
    {
        ForceZero(joint.XDrive, "xDrive", at);
        ForceZero(joint.YDrive, "yDrive", at);
        ForceZero(joint.ZDrive, "zDrive", at);
        ForceZero(joint.AngularXDrive, "angularXDrive", at);
        ForceZero(joint.AngularYZDrive, "angularYZDrive", at);
        ForceZero(joint.SlerpDrive, "slerpDrive", at);
    }

    private static bool IsLocked(ConfigurableJointMotion motion) => motion == ConfigurableJointMotion.Locked;

    private static bool Acts(JointDrive drive) => drive.PositionSpring > 0 || drive.PositionDamper > 0;

    private static void Numbers(JointDrive drive, string field, in Place at)
    {
        if (ReferenceEquals(drive, JointDrive.Default))
            return;
        NumberRules.NotNegative(at, field + "/positionSpring", drive.PositionSpring);
        NumberRules.NotNegative(at, field + "/positionDamper", drive.PositionDamper);
        NumberRules.NotNegativeOrUnlimited(at, field + "/maximumForce", drive.MaximumForce);
    }

    private static void Unused(JointDrive drive, string field, string mode, in Place at)
    {
        if (Acts(drive))
            at.Report(field, DiagnosticCodes.DriveOfOtherMode, ("mode", mode));
    }

    private static void Locked(JointDrive drive, bool locked, string field, in Place at)
    {
        if (locked && Acts(drive))
            at.Report(field, DiagnosticCodes.DriveOnLockedFreedom);
    }

    private static void ForceZero(JointDrive drive, string field, in Place at)
    {
        if (drive.MaximumForce == 0)
            at.Report(field + "/maximumForce", DiagnosticCodes.DriveMaximumForceZero);
    }
}
