using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>
/// ConfigurableJoint with Unity's own senses: X limits, targetPosition, targetVelocity and targetRotation say how
/// the connected body stands to the own one, so they run against the own body's motion.
/// </summary>
public sealed partial record ConfigurableJoint : AnchoredJoint
{
    /// <summary>Own local direction that the joint's Y comes closest to.</summary>
    public Vector3d SecondaryAxis { get; init; } = Vector3d.UnitY;

    /// <summary>Translation along the joint's X.</summary>
    public ConfigurableJointMotion XMotion { get; init; } = ConfigurableJointMotion.Free;

    /// <summary>Translation along the joint's Y.</summary>
    public ConfigurableJointMotion YMotion { get; init; } = ConfigurableJointMotion.Free;

    /// <summary>Translation along the joint's Z.</summary>
    public ConfigurableJointMotion ZMotion { get; init; } = ConfigurableJointMotion.Free;

    /// <summary>Rotation about the joint's X (twist).</summary>
    public ConfigurableJointMotion AngularXMotion { get; init; } = ConfigurableJointMotion.Free;

    /// <summary>Rotation about the joint's Y (swing).</summary>
    public ConfigurableJointMotion AngularYMotion { get; init; } = ConfigurableJointMotion.Free;

    /// <summary>Rotation about the joint's Z (swing).</summary>
    public ConfigurableJointMotion AngularZMotion { get; init; } = ConfigurableJointMotion.Free;

    /// <summary>Softness of <see cref="LinearLimit"/>.</summary>
    public SoftJointLimitSpring LinearLimitSpring { get; init; } = SoftJointLimitSpring.Default;

    /// <summary>ONE radius, metres, for all Limited linear axes together.</summary>
    public SoftJointLimit LinearLimit { get; init; } = SoftJointLimit.Default;

    /// <summary>Softness of the X limits.</summary>
    public SoftJointLimitSpring AngularXLimitSpring { get; init; } = SoftJointLimitSpring.Default;

    /// <summary>Lower limit about X, degrees.</summary>
    public SoftJointLimit LowAngularXLimit { get; init; } = SoftJointLimit.Default;

    /// <summary>Upper limit about X, degrees.</summary>
    public SoftJointLimit HighAngularXLimit { get; init; } = SoftJointLimit.Default;

    /// <summary>Softness of the Y and Z limits.</summary>
    public SoftJointLimitSpring AngularYZLimitSpring { get; init; } = SoftJointLimitSpring.Default;

    /// <summary>Limit about Y, degrees, symmetric.</summary>
    public SoftJointLimit AngularYLimit { get; init; } = SoftJointLimit.Default;

    /// <summary>Limit about Z, degrees, symmetric.</summary>
    public SoftJointLimit AngularZLimit { get; init; } = SoftJointLimit.Default;

    /// <summary>Metres, joint frame.</summary>
    public Vector3d TargetPosition { get; init; }

    /// <summary>m/s, joint frame.</summary>
    public Vector3d TargetVelocity { get; init; }

    /// <summary>Drive along the joint's X.</summary>
    public JointDrive XDrive { get; init; } = JointDrive.Default;

    /// <summary>Drive along the joint's Y.</summary>
    public JointDrive YDrive { get; init; } = JointDrive.Default;

    /// <summary>Drive along the joint's Z.</summary>
    public JointDrive ZDrive { get; init; } = JointDrive.Default;

    /// <summary>Joint frame, against the start-up pose.</summary>
    public Quaterniond TargetRotation { get; init; } = Quaterniond.Identity;

    /// <summary>RADIANS per second, joint frame.</summary>
    public Vector3d TargetAngularVelocity { get; init; }

    /// <summary>Which of the angular drives act.</summary>
    public RotationDriveMode RotationDriveMode { get; init; }

    /// <summary>Drive about X, in mode XYAndZ.</summary>
    public JointDrive AngularXDrive { get; init; } = JointDrive.Default;

    /// <summary>Drive about Y and Z, in mode XYAndZ.</summary>
    public JointDrive AngularYZDrive { get; init; } = JointDrive.Default;

    /// <summary>Drive about all axes, in mode Slerp; needs three unlocked angular axes.</summary>
    public JointDrive SlerpDrive { get; init; } = JointDrive.Default;

    /// <summary>Whether PhysX snaps the joint together.</summary>
    public JointProjectionMode ProjectionMode { get; init; }

    /// <summary>Metres.</summary>
    public double ProjectionDistance { get; init; } = 0.1;

    /// <summary>Degrees.</summary>
    public double ProjectionAngle { get; init; } = 180;

    /// <summary>axis, secondaryAxis and all targets are read as world directions.</summary>
    public bool ConfiguredInWorldSpace { get; init; }

    /// <summary>As if the component stood on the connected body.</summary>
    public bool SwapBodies { get; init; }

    /// <summary>
    /// Effort, speed, friction and armature of each coordinate, where they differ. A coordinate of which something is stated here has
    /// nothing of the joint's own four.
    /// </summary>
    [Since(1)]
    public StatedAxes Stated { get; init; } = StatedAxes.Default;

    internal override StatedAxis StatedOf(Coordinate coordinate) => Stated[coordinate] is var own && own != StatedAxis.Default ? own : base.StatedOf(coordinate);

    private protected override string Describe() => $"ConfigurableJoint {Ends}, x {XMotion}, y {YMotion}, z {ZMotion}, angularX {AngularXMotion}, angularY {AngularYMotion}, angularZ {AngularZMotion}";
}
