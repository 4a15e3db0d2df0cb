namespace Kinefab.Document;

/// <summary>What the source states of each coordinate of a joint whose coordinates differ in it.</summary>
[Since(1)]
public sealed partial record StatedAxes : DocumentObject
{
    /// <summary>Nothing stated of any.</summary>
    public static StatedAxes Default { get; } = new();

    /// <summary>Of the translation along the joint's X.</summary>
    public StatedAxis X { get; init; } = StatedAxis.Default;

    /// <summary>Of the translation along the joint's Y.</summary>
    public StatedAxis Y { get; init; } = StatedAxis.Default;

    /// <summary>Of the translation along the joint's Z.</summary>
    public StatedAxis Z { get; init; } = StatedAxis.Default;

    /// <summary>Of the rotation about the joint's X.</summary>
    public StatedAxis AngularX { get; init; } = StatedAxis.Default;

    /// <summary>Of the rotation about the joint's Y.</summary>
    public StatedAxis AngularY { get; init; } = StatedAxis.Default;

    /// <summary>Of the rotation about the joint's Z.</summary>
    public StatedAxis AngularZ { get; init; } = StatedAxis.Default;

    /// <summary>What is stated of a coordinate; of a hinge's angle nothing, whose joint says it itself.</summary>
    public StatedAxis this[Coordinate coordinate] => coordinate switch
    {
        Coordinate.X => X,
        Coordinate.Y => Y,
        Coordinate.Z => Z,
        Coordinate.AngularX => AngularX,
        Coordinate.AngularY => AngularY,
        Coordinate.AngularZ => AngularZ,
        _ => StatedAxis.Default,
    };

    private protected override string Describe() => $"stated of x: {X}; y: {Y}; z: {Z}; angularX: {AngularX}; angularY: {AngularY}; angularZ: {AngularZ}";
}
