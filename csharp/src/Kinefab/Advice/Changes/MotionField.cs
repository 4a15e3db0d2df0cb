using System;
using System.Linq;
using Kinefab.Document;

namespace Kinefab.Advice.Changes;

/// <summary>One of the six motions of a ConfigurableJoint: its field, its name in the Inspector, its value.</summary>
internal sealed class MotionField
{
    private readonly Func<ConfigurableJoint, ConfigurableJointMotion> _value;

    private MotionField(Coordinate coordinate, string name, string label, Func<ConfigurableJoint, ConfigurableJointMotion> value)
    {
        Coordinate = coordinate;
        Name = name;
        Label = label;
        _value = value;
    }

    /// <summary>All six; the angular ones that a hinge locks first.</summary>
    public static MotionField[] All { get; } =
    {
        new(Coordinate.AngularY, "angularYMotion", "Angular Y Motion", j => j.AngularYMotion),
        new(Coordinate.AngularZ, "angularZMotion", "Angular Z Motion", j => j.AngularZMotion),
        new(Coordinate.Z, "zMotion", "Z Motion", j => j.ZMotion),
        new(Coordinate.Y, "yMotion", "Y Motion", j => j.YMotion),
        new(Coordinate.X, "xMotion", "X Motion", j => j.XMotion),
        new(Coordinate.AngularX, "angularXMotion", "Angular X Motion", j => j.AngularXMotion),
    };

    public Coordinate Coordinate { get; }

    public string Name { get; }

    public string Label { get; }

    public static MotionField Of(Coordinate coordinate) => All.First(field => field.Coordinate == coordinate);

    public ConfigurableJointMotion In(ConfigurableJoint joint) => _value(joint);
}
