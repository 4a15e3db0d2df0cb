using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>Kinds of geometry that a constraint refers to.</summary>
[Words(Letters.Camel)]
public enum FeatureKind
{
    /// <summary>A point.</summary>
    Point,

    /// <summary>A straight line.</summary>
    Line,

    /// <summary>A plane.</summary>
    Plane,

    /// <summary>A circle.</summary>
    Circle,

    /// <summary>A cylinder.</summary>
    Cylinder,

    /// <summary>A sphere.</summary>
    Sphere,

    /// <summary>A cone.</summary>
    Cone,

    /// <summary>A coordinate frame.</summary>
    Frame,

    /// <summary>A whole body.</summary>
    Body,
}

/// <summary>Geometry that a constraint refers to, in the local frame of its GameObject, or in the world.</summary>
public sealed partial record Feature : DocumentObject
{
    /// <summary>Index of the GameObject; null: the ground.</summary>
    public int? GameObject { get; init; }

    /// <summary>Kind.</summary>
    [Field(Required = true)]
    public FeatureKind Kind { get; init; }

    /// <summary>Metres.</summary>
    public Vector3d? Point { get; init; }

    /// <summary>Unit.</summary>
    public Vector3d? Direction { get; init; }

    /// <summary>Unit.</summary>
    public Vector3d? Secondary { get; init; }

    /// <summary>Metres.</summary>
    public double Radius { get; init; }

    /// <summary>Degrees.</summary>
    public double HalfAngle { get; init; }
}
