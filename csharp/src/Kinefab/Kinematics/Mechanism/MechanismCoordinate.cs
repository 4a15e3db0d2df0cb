using System;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// One coordinate of a joint, read as Unity reads it: the own body against the connected one, by the left-hand
/// rule about the axis or along it, zero at the exported pose; degrees (over any number of turns) or metres.
/// </summary>
public sealed class MechanismCoordinate
{
    private readonly Joints.CoordinateAxisMap _coordinate;

    internal MechanismCoordinate(int gameObject, int component, Coordinate coordinate, int joint, Joints.CoordinateAxisMap source, bool isLocked)
    {
        GameObject = gameObject;
        Component = component;
        Coordinate = coordinate;
        Joint = joint;
        IsLocked = isLocked;
        _coordinate = source;
    }

    /// <summary>
    /// What it is called in trajectories and on the command line: the GameObject's id and the coordinate, Lever/Crank:1.angle;
    /// with the component's index, Arm:2[3].angularX, where one object carries several joints that move.
    /// </summary>
    public string Name { get; internal set; } = "";

    /// <summary>Index of the GameObject that carries the joint.</summary>
    public int GameObject { get; }

    /// <summary>Index of the joint in its components.</summary>
    public int Component { get; }

    /// <summary>Which coordinate of that joint.</summary>
    public Coordinate Coordinate { get; }

    /// <summary>Degrees when true, metres when false.</summary>
    public bool IsAngle => _coordinate.IsAngle;

    /// <summary>The joint holds it still: it stands here only because a coupling names it.</summary>
    public bool IsLocked { get; }

    internal int Joint { get; }

    /// <summary>Whether it grows with the rows' own coordinate, actor 1 against actor 0.</summary>
    internal bool IsAlongRows => _coordinate.Sign > 0;

    internal Joints.JointModel JointRows => _coordinate.Joint;

    /// <summary>The joint's own value at the exported pose: a slide's anchors may stand apart there.</summary>
    internal double Zero { get; set; }

    /// <summary>The same coordinate of a copy of its joint in another list of joints.</summary>
    internal MechanismCoordinate On(int joint, Joints.JointModel rows) =>
        new(GameObject, Component, Coordinate, joint, new Joints.CoordinateAxisMap(rows, _coordinate.Axis, _coordinate.Sign), IsLocked) { Zero = Zero };

    internal double Evaluate(in Pose body0, in Pose body1, double near, out Joints.ConstraintRow row) =>
        _coordinate.Evaluate(body0, body1, near, out row);

    internal double ToInternal(double value) => Zero + (IsAngle ? value * (Math.PI / 180) : value);

    internal double ToExternal(double value) => IsAngle ? (value - Zero) * (180 / Math.PI) : value - Zero;
}
