using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Document;

/// <summary>The words of the scene file for each enumeration.</summary>
internal static class DocumentWords
{
    internal static readonly Words<Axis> Axes = new(("X", Axis.X), ("Y", Axis.Y), ("Z", Axis.Z));

    internal static readonly Words<RigidbodyInterpolation> Interpolation = new(
        ("None", RigidbodyInterpolation.None),
        ("Interpolate", RigidbodyInterpolation.Interpolate),
        ("Extrapolate", RigidbodyInterpolation.Extrapolate));

    internal static readonly Words<RigidbodyConstraints> RigidbodyConstraint = new(
        ("FreezePositionX", RigidbodyConstraints.FreezePositionX),
        ("FreezePositionY", RigidbodyConstraints.FreezePositionY),
        ("FreezePositionZ", RigidbodyConstraints.FreezePositionZ),
        ("FreezeRotationX", RigidbodyConstraints.FreezeRotationX),
        ("FreezeRotationY", RigidbodyConstraints.FreezeRotationY),
        ("FreezeRotationZ", RigidbodyConstraints.FreezeRotationZ));

    internal static readonly Words<CollisionDetectionMode> CollisionDetection = new(
        ("Discrete", CollisionDetectionMode.Discrete),
        ("Continuous", CollisionDetectionMode.Continuous),
        ("ContinuousDynamic", CollisionDetectionMode.ContinuousDynamic),
        ("ContinuousSpeculative", CollisionDetectionMode.ContinuousSpeculative));

    internal static readonly Words<ConfigurableJointMotion> Motions = new(
        ("Locked", ConfigurableJointMotion.Locked),
        ("Limited", ConfigurableJointMotion.Limited),
        ("Free", ConfigurableJointMotion.Free));

    internal static readonly Words<RotationDriveMode> RotationDriveModes = new(
        ("XYAndZ", RotationDriveMode.XYAndZ),
        ("Slerp", RotationDriveMode.Slerp));

    internal static readonly Words<JointProjectionMode> ProjectionModes = new(
        ("None", JointProjectionMode.None),
        ("PositionAndRotation", JointProjectionMode.PositionAndRotation));

    internal static readonly Words<IndexFormat> IndexFormats = new(("uint16", IndexFormat.UInt16), ("uint32", IndexFormat.UInt32));

    internal static readonly Words<CouplingKind> CouplingKinds = new(
        ("gear", CouplingKind.Gear),
        ("belt", CouplingKind.Belt),
        ("rack", CouplingKind.Rack),
        ("screw", CouplingKind.Screw),
        ("linear", CouplingKind.Linear));

    internal static readonly Words<Coordinate> Coordinates = new(
        ("angle", Coordinate.Angle),
        ("x", Coordinate.X),
        ("y", Coordinate.Y),
        ("z", Coordinate.Z),
        ("angularX", Coordinate.AngularX),
        ("angularY", Coordinate.AngularY),
        ("angularZ", Coordinate.AngularZ));

    internal static readonly Words<WrapMode> WrapModes = new(
        ("Once", WrapMode.Once),
        ("Loop", WrapMode.Loop),
        ("PingPong", WrapMode.PingPong));

    internal static readonly Words<FeatureKind> FeatureKinds = new(
        ("point", FeatureKind.Point),
        ("line", FeatureKind.Line),
        ("plane", FeatureKind.Plane),
        ("circle", FeatureKind.Circle),
        ("cylinder", FeatureKind.Cylinder),
        ("sphere", FeatureKind.Sphere),
        ("cone", FeatureKind.Cone),
        ("frame", FeatureKind.Frame),
        ("body", FeatureKind.Body));

    internal static readonly Words<ConstraintKind> ConstraintKinds = new(
        ("coincident", ConstraintKind.Coincident),
        ("concentric", ConstraintKind.Concentric),
        ("parallel", ConstraintKind.Parallel),
        ("perpendicular", ConstraintKind.Perpendicular),
        ("angle", ConstraintKind.Angle),
        ("distance", ConstraintKind.Distance),
        ("tangent", ConstraintKind.Tangent),
        ("insert", ConstraintKind.Insert),
        ("symmetry", ConstraintKind.Symmetry),
        ("lock", ConstraintKind.Lock),
        ("lock_orientation", ConstraintKind.LockOrientation),
        ("slider", ConstraintKind.Slider),
        ("pin_slot", ConstraintKind.PinSlot),
        ("universal", ConstraintKind.Universal),
        ("screw", ConstraintKind.Screw),
        ("gear", ConstraintKind.Gear),
        ("belt", ConstraintKind.Belt),
        ("rack", ConstraintKind.Rack),
        ("linear", ConstraintKind.Linear),
        ("ground", ConstraintKind.Ground),
        ("other", ConstraintKind.Other));

    internal static readonly Words<ConstraintSense> ConstraintSenses = new(
        ("aligned", ConstraintSense.Aligned),
        ("opposed", ConstraintSense.Opposed),
        ("either", ConstraintSense.Either));

    internal static readonly Words<ConstraintSide> ConstraintSides = new(
        ("inside", ConstraintSide.Inside),
        ("outside", ConstraintSide.Outside),
        ("either", ConstraintSide.Either));

    internal static readonly Words<Outcome> Outcomes = new(
        ("kept", Outcome.Kept),
        ("approximated", Outcome.Approximated),
        ("dropped", Outcome.Dropped));

    internal static readonly Words<Severity> Severities = new(
        ("error", Severity.Error),
        ("warning", Severity.Warning),
        ("info", Severity.Info));
}
