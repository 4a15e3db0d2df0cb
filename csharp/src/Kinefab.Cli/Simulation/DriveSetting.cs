using System;
using System.Globalization;
using System.Linq;
using Kinefab.Cli.Motion;
using Kinefab.Diagnostics;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Validation;

namespace Kinefab.Cli.Simulation;

/// <summary>JOINT[.COORDINATE]=VALUE[/s] of the command line, read against a world; joints are named as a mechanism names them.</summary>
/// <param name="Text">As it was given.</param>
/// <param name="Joint">The one that it drives.</param>
/// <param name="Coordinate">What of it.</param>
/// <param name="Asked">Degrees or metres, at a speed so many a second.</param>
/// <param name="IsSpeed">Whether it asks for a speed, not for a place.</param>
internal sealed record DriveSetting(string Text, WorldJoint Joint, MechanismCoordinate Coordinate, double Asked, bool IsSpeed)
{
    private const string Speed = "/s";

    // A turn of more than this in one step looks like one the other way round.
    private const double HalfTurn = 180;

    // Limits come as Unity's 32-bit numbers.
    private const double Rounding = 1e-6;

    /// <summary>deg, m, deg/s or m/s.</summary>
    internal string Unit => Coordinate.Unit + (IsSpeed ? Speed : "");

    /// <summary>What it drives now: degrees or metres.</summary>
    internal double Value => Joint.Coordinate(Coordinate.Coordinate);

    /// <summary>The drive, or null and what is wrong with the text.</summary>
    internal static DriveSetting? Read(World world, Mechanism mechanism, string text, out string fault)
    {
        int equals = text.LastIndexOf('=');
        if (equals <= 0)
            return Wrong("it needs the form JOINT[.COORDINATE]=VALUE[/s].", out fault);
        string value = text[(equals + 1)..];
        bool isSpeed = value.EndsWith(Speed, StringComparison.Ordinal);
        if (!double.TryParse(isSpeed ? value[..^Speed.Length] : value, NumberStyles.Float, CultureInfo.InvariantCulture, out double number) || !double.IsFinite(number))
            return Wrong($"{value} is not a number.", out fault);
        if (!mechanism.TryFindCoordinate(text[..equals], out int index, out string problem))
            return Wrong(problem, out fault);
        MechanismCoordinate found = mechanism.Coordinates[index];
        if (found.IsLocked)
            return Wrong($"the joint does not move along {found.Coordinate.ToJson()}.", out fault);
        WorldJoint joint = world.Joints.Single(j => j.GameObject == found.GameObject && j.Component == found.Component);
        var drive = new DriveSetting(text, joint, found, number, isSpeed);
        if (CoordinateText.RangeFault(found, number, drive.Unit) is string range)
            return Wrong($"it {range}.", out fault);
        fault = "";
        return drive;
    }

    internal void Apply()
    {
        if (IsSpeed)
            Joint.DriveAt(Coordinate.Coordinate, Asked);
        else
            Joint.DriveTo(Coordinate.Coordinate, Asked);
    }

    /// <summary>What can be told before the run of where it leads; null: nothing is amiss.</summary>
    internal Diagnostic? Doubt(ValidScene scene, double step) => IsSpeed ? Coarse(step) : Beyond(scene);

    private Diagnostic? Beyond(ValidScene scene)
    {
        JointFreedom own = scene.Freedoms(Joint.GameObject, Joint.Component).FirstOrDefault(freedom => freedom.Coordinate == Coordinate.Coordinate);
        double slack = Rounding * Math.Abs(Asked);
        if (!own.IsLimited || (Asked >= own.Lower - slack && Asked <= own.Upper + slack))
            return null;
        return Diagnostic.Of(
            DiagnosticCodes.DriveBeyondLimits,
            Pointer,
            ("coordinate", Coordinate.ShortName),
            ("target", Shown(Asked)),
            ("limit", Shown(Asked < own.Lower ? own.Lower : own.Upper)),
            ("lower", CoordinateText.Number(own.Lower)),
            ("upper", Shown(own.Upper)));
    }

    private Diagnostic? Coarse(double step)
    {
        double angle = Math.Abs(Asked) * step;
        if (!Coordinate.IsAngle || angle < HalfTurn)
            return null;
        return Diagnostic.Of(
            DiagnosticCodes.DriveSpeedCoarse,
            Pointer,
            ("coordinate", Coordinate.ShortName),
            ("speed", Shown(Asked)),
            ("angle", CoordinateText.Number(angle)),
            ("step", step.ToString(CultureInfo.InvariantCulture)),
            ("most", CoordinateText.Number(HalfTurn / step)));
    }

    private string Pointer => FormattableString.Invariant($"/gameObjects/{Joint.GameObject}/components/{Joint.Component}");

    private string Shown(double value) => $"{CoordinateText.Number(value)} {Unit}";

    private static DriveSetting? Wrong(string reason, out string fault)
    {
        fault = reason;
        return null;
    }
}
