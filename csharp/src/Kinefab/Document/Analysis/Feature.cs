using Kinefab.Json;
using Kinefab.Numerics;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Kinds of geometry that a constraint refers to.</summary>
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
public sealed record Feature : DocumentObject
{
    internal static readonly FieldNames Fields = new(
        ["kind"],
        "gameObject", "point", "direction", "secondary", "radius", "halfAngle", "extras");

    /// <summary>With nothing stated.</summary>
    public Feature()
    {
    }

    internal Feature(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "gameObject":
                    GameObject = json.Int();
                    break;
                case "kind":
                    Kind = json.Word(FeatureKindWords.Table);
                    break;
                case "point":
                    Point = json.Vector3();
                    break;
                case "direction":
                    Direction = json.Vector3();
                    break;
                case "secondary":
                    Secondary = json.Vector3();
                    break;
                case "radius":
                    Radius = json.Number();
                    break;
                case "halfAngle":
                    HalfAngle = json.Number();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Index of the GameObject; null: the ground.</summary>
    public int? GameObject { get; init; }

    /// <summary>Kind.</summary>
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

/// <summary>The words of the scene file for <see cref="FeatureKind"/>.</summary>
internal static class FeatureKindWords
{
    internal static readonly Words<FeatureKind> Table = new(
        ("point", FeatureKind.Point),
        ("line", FeatureKind.Line),
        ("plane", FeatureKind.Plane),
        ("circle", FeatureKind.Circle),
        ("cylinder", FeatureKind.Cylinder),
        ("sphere", FeatureKind.Sphere),
        ("cone", FeatureKind.Cone),
        ("frame", FeatureKind.Frame),
        ("body", FeatureKind.Body));
}
