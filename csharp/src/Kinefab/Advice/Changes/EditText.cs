using System.Globalization;
using Kinefab.Dynamics;
using Kinefab.Json;
using Kinefab.Numerics;

namespace Kinefab.Advice.Changes;

/// <summary>Places and values of edits as text.</summary>
internal static class EditText
{
    public static string Component(int gameObject, int component) => $"/gameObjects/{Invariant.Text(gameObject)}/components/{Invariant.Text(component)}";

    public static string Pointer(WorldJoint joint) => Component(joint.GameObject, joint.Component);

    /// <summary>A number that people would write, three digits; what is written is what is tried.</summary>
    public static string Number(double value) => Rounded(value, "G3");

    /// <summary>Moments of inertia keep more digits: of a flat body the largest is the sum of the others.</summary>
    public static string Moments(Vector3d moments) => $"[{Rounded(moments.X, "G6")}, {Rounded(moments.Y, "G6")}, {Rounded(moments.Z, "G6")}]";

    /// <summary>A vector as people read it.</summary>
    public static string Vector(Vector3d v) => $"({Number(v.X)}, {Number(v.Y)}, {Number(v.Z)})";

    private static string Rounded(double value, string format) =>
        Invariant.Text(double.Parse(value.ToString(format, CultureInfo.InvariantCulture), CultureInfo.InvariantCulture));
}
