using System;
using System.Globalization;
using System.Linq;
using Kinefab.Dynamics;
using Kinefab.Kinematics;

namespace Kinefab.Cli.Simulation;

/// <summary>JOINT[.COORDINATE]=VALUE[/s] of the command line, applied to a world; joints are named as a mechanism names them.</summary>
internal static class DriveSetting
{
    private const string Speed = "/s";

    /// <summary>Null when done, else what is wrong with the text.</summary>
    internal static string? Apply(World world, Mechanism mechanism, string text)
    {
        int equals = text.LastIndexOf('=');
        if (equals <= 0)
            return "it needs the form JOINT[.COORDINATE]=VALUE[/s].";
        string value = text[(equals + 1)..];
        bool isSpeed = value.EndsWith(Speed, StringComparison.Ordinal);
        if (!double.TryParse(isSpeed ? value[..^Speed.Length] : value, NumberStyles.Float, CultureInfo.InvariantCulture, out double number) || !double.IsFinite(number))
            return $"{value} is not a number.";
        if (!mechanism.TryFindCoordinate(text[..equals], out int index, out string problem))
            return problem;
        MechanismCoordinate found = mechanism.Coordinates[index];
        if (found.IsLocked)
            return $"the joint does not move along {found.Coordinate.ToJson()}.";
        WorldJoint joint = world.Joints.Single(j => j.GameObject == found.GameObject && j.Component == found.Component);
        if (isSpeed)
            joint.DriveAt(found.Coordinate, number);
        else
            joint.DriveTo(found.Coordinate, number);
        return null;
    }
}
