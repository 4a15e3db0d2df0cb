using System.Diagnostics;
using System;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Mechanisms;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// One coordinate of a joint, read as Unity reads it: the own body against the connected one, by the left-hand
/// rule about the axis or along it, zero at the exported pose; degrees (over any number of turns) or metres.
/// </summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class MechanismCoordinate
{
    private readonly Joints.CoordinateAxisMap _coordinate;

    private readonly (double Sign, double Offset) _cad;

    private CoordinateNames? _names;
    private int _index;
    private string? _shortName;

    internal MechanismCoordinate(int gameObject, int component, Coordinate coordinate, int joint, Joints.CoordinateAxisMap source, bool isLocked, (double Sign, double Offset) cad)
    {
        _cad = cad;
        GameObject = gameObject;
        Component = component;
        Coordinate = coordinate;
        Joint = joint;
        IsLocked = isLocked;
        _coordinate = source;
    }

    /// <summary>Once all coordinates are there: only then is it known what a name finds.</summary>
    internal void TakeName(CoordinateNames names, int index)
    {
        _names = names;
        _index = index;
        Name = names[index];
    }

    /// <summary>
    /// What it is called in trajectories and on the command line: the GameObject's id and the coordinate, Lever/Crank:1.angle;
    /// with the component's index, Arm:2[3].angularX, where one object carries several joints that move.
    /// </summary>
    public string Name { get; private set; } = "";

    /// <summary>
    /// The shortest of the names that find it: what the source calls its joint (Shaft), with the coordinate behind it where the
    /// joint has several (Arm.angularX); else the GameObject's id, else <see cref="Name"/>.
    /// </summary>
    public string ShortName => _shortName ??= _names!.Short(_index);

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

    /// <summary>Degrees or metres, for messages and headings.</summary>
    public string Unit => IsAngle ? "deg" : "m";

    /// <summary>Degrees that an angle may be asked to go at most, see <see cref="Farthest"/>.</summary>
    public const double FarthestDegrees = 360_000;

    /// <summary>Metres that a slide may be asked to go at most, see <see cref="Farthest"/>.</summary>
    public const double FarthestMetres = 1000;

    /// <summary>How far it may be asked to go at once from where it stands, either way, degrees or metres: all of the way is walked in small steps.</summary>
    public double Farthest => IsAngle ? FarthestDegrees : FarthestMetres;

    /// <summary>
    /// A value of this coordinate as the source shows it, as far as the file tells: the sense of hinges, of slides and of turns
    /// about the axis of a slide; a file of format 1.0 tells no offset, so that zero is the exported pose.
    /// </summary>
    /// <param name="value">Unity's, degrees or metres.</param>
    /// <returns>Degrees or metres, in the source's sense.</returns>
    public double ToCad(double value) => _cad.Sign * value + _cad.Offset;

    /// <summary>The value of this coordinate that the source shows as another: the way back from <see cref="ToCad"/>.</summary>
    /// <param name="shown">The source's, degrees or metres.</param>
    /// <returns>Degrees or metres, left-handed sense, zero at the exported pose.</returns>
    public double FromCad(double shown) => _cad.Sign * (shown - _cad.Offset);

    /// <summary>Lever/Crank:1.angle [deg].</summary>
    public override string ToString() => $"{Name} [{Unit}]{(IsLocked ? ", locked" : "")}";

    internal int Joint { get; }

    /// <summary>A value that a program asks for where the coordinate stands at another.</summary>
    /// <exception cref="ArgumentOutOfRangeException">It is no finite number, or farther away than <see cref="Farthest"/>.</exception>
    internal void Demand(double value, double from, string argument)
    {
        if (!Finite.Is(value))
            throw new ArgumentOutOfRangeException(argument, $"The target of {Name} is not a finite number.");
        if (!(Math.Abs(value - from) <= Farthest))
            throw new ArgumentOutOfRangeException(argument, $"{Invariant.Text(value)}: {Name} goes at most {Invariant.Text(Farthest)} {Unit} at once, and stands at {Invariant.Text(from)}.");
    }

    /// <summary>Whether it grows with the rows' own coordinate, actor 1 against actor 0.</summary>
    internal bool IsAlongRows => _coordinate.Sign > 0;

    /// <summary>Whether it is an angle of a joint that turns about other axes too, which has no value where those come to half a turn.</summary>
    internal bool IsAngleAmongOthers => Joints.CoordinateCoupling.IsAmongOthers(_coordinate);

    /// <summary>As the rows have it: 1, or -1 when it is that of actor 0 against actor 1.</summary>
    internal double Sign => _coordinate.Sign;

    /// <summary>Of an angle: 0, 1 or 2.</summary>
    internal int AngleAxis => _coordinate.Axis - Joints.CoordinateAxis.AngularX;

    internal Joints.JointModel JointRows => _coordinate.Joint;

    /// <summary>The joint's own value at the exported pose: a slide's anchors may stand apart there.</summary>
    internal double Zero { get; set; }

    /// <summary>The same coordinate of a copy of its joint in another list of joints.</summary>
    internal MechanismCoordinate On(int joint, Joints.JointModel rows) =>
        new(GameObject, Component, Coordinate, joint, new Joints.CoordinateAxisMap(rows, _coordinate.Axis, _coordinate.Sign), IsLocked, _cad) { Zero = Zero };

    internal double Evaluate(in Pose body0, in Pose body1, double near, out Joints.ConstraintRow row) =>
        _coordinate.Evaluate(body0, body1, near, out row);

    internal double ToInternal(double value) => Zero + (IsAngle ? value * (Math.PI / 180) : value);

    internal double ToExternal(double value) => IsAngle ? (value - Zero) * (180 / Math.PI) : value - Zero;
}
