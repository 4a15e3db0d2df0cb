namespace Kinefab.Document;

/// <summary>Which coordinate of a joint is meant.</summary>
[Words(Letters.Camel)]
public enum Coordinate
{
    /// <summary>The angle of a HingeJoint, degrees.</summary>
    Angle,

    /// <summary>Translation along the X of a ConfigurableJoint, metres.</summary>
    X,

    /// <summary>Translation along the Y of a ConfigurableJoint, metres.</summary>
    Y,

    /// <summary>Translation along the Z of a ConfigurableJoint, metres.</summary>
    Z,

    /// <summary>Rotation about the X of a ConfigurableJoint, degrees.</summary>
    AngularX,

    /// <summary>Rotation about the Y of a ConfigurableJoint, degrees.</summary>
    AngularY,

    /// <summary>Rotation about the Z of a ConfigurableJoint, degrees.</summary>
    AngularZ,
}

/// <summary>
/// A coordinate of a joint component: the motion of the own body against the connected one along or about the
/// joint's axis in Unity's left-handed sense (never the inverted sense of targets and X limits), zero at start-up.
/// </summary>
public sealed partial record JointCoordinate : DocumentObject
{
    /// <summary>Index of the GameObject that carries the joint.</summary>
    [Field(Required = true)]
    public int GameObject { get; init; }

    /// <summary>Index of the joint in that GameObject's components.</summary>
    [Field(Required = true)]
    public int Component { get; init; }

    /// <summary>Which of its coordinates.</summary>
    [Field(Required = true)]
    public Coordinate Coordinate { get; init; }

    private protected override string Describe() => $"{Coordinate} of components[{Component}] of object {GameObject}";
}
