using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Which coordinate of a joint is meant.</summary>
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
public sealed record JointCoordinate : DocumentObject
{
    internal static readonly FieldNames Fields = new(["gameObject", "component", "coordinate"], "extras");

    /// <summary>With nothing stated.</summary>
    public JointCoordinate()
    {
    }

    internal JointCoordinate(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "gameObject":
                    GameObject = json.Int();
                    break;
                case "component":
                    Component = json.Int();
                    break;
                case "coordinate":
                    Coordinate = json.Word(CoordinateWords.Table);
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Index of the GameObject that carries the joint.</summary>
    public int GameObject { get; init; }

    /// <summary>Index of the joint in that GameObject's components.</summary>
    public int Component { get; init; }

    /// <summary>Which of its coordinates.</summary>
    public Coordinate Coordinate { get; init; }

    private protected override string Describe() => $"{Coordinate} of components[{Component}] of object {GameObject}";
}

/// <summary>The words of the scene file for <see cref="Coordinate"/>.</summary>
internal static class CoordinateWords
{
    internal static readonly Words<Coordinate> Table = new(
        ("angle", Coordinate.Angle),
        ("x", Coordinate.X),
        ("y", Coordinate.Y),
        ("z", Coordinate.Z),
        ("angularX", Coordinate.AngularX),
        ("angularY", Coordinate.AngularY),
        ("angularZ", Coordinate.AngularZ));
}
