namespace Kinefab.Joints;

/// <summary>Axis of a joint frame along or about which a coordinate is measured.</summary>
internal enum CoordinateAxis : byte
{
    X,
    Y,
    Z,
    AngularX,
    AngularY,
    AngularZ,
}
