using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Validation;

namespace Kinefab.Cli.Simulation;

/// <summary>JOINT[.COORDINATE]=VALUE[/s] of the command line, applied to a world.</summary>
internal static class DriveSetting
{
    private const string Speed = "/s";

    /// <summary>Null when done, else what is wrong with the text.</summary>
    internal static string? Apply(World world, ValidScene scene, string text)
    {
        int equals = text.LastIndexOf('=');
        if (equals <= 0)
            return "it needs the form JOINT[.COORDINATE]=VALUE[/s].";
        string name = text[..equals];
        string value = text[(equals + 1)..];
        bool isSpeed = value.EndsWith(Speed, StringComparison.Ordinal);
        if (!double.TryParse(isSpeed ? value[..^Speed.Length] : value, NumberStyles.Float, CultureInfo.InvariantCulture, out double number) || !double.IsFinite(number))
            return $"{value} is not a number.";

        // An id may hold dots itself, so the whole name is tried before its last part is taken for a coordinate.
        List<WorldJoint> joints = Named(world, scene, name);
        Coordinate? coordinate = null;
        int dot = name.LastIndexOf('.');
        if (joints.Count == 0 && dot > 0 && Enum.TryParse(name[(dot + 1)..], ignoreCase: true, out Coordinate parsed))
        {
            joints = Named(world, scene, name[..dot]);
            coordinate = parsed;
        }

        return joints.Count switch
        {
            0 => Stranger(world, scene, name, dot) ?? $"no joint stands on an object of this id or name; there are {string.Join(", ", world.Joints.Select(j => j.Id).Distinct())}.",
            1 => Drive(joints[0], coordinate, number, isSpeed),
            _ => $"{joints.Count} joints go by this name; use an id that only one has.",
        };
    }

    private static List<WorldJoint> Named(World world, ValidScene scene, string name)
    {
        List<WorldJoint> joints = world.Joints.Where(j => j.Id == name).ToList();
        return joints.Count > 0 ? joints : world.Joints.Where(j => scene.Document.GameObjects[j.GameObject].Name == name).ToList();
    }

    // JOINT.WORD of a joint that is there: the word is no coordinate.
    private static string? Stranger(World world, ValidScene scene, string name, int dot)
    {
        List<WorldJoint> joints = dot > 0 ? Named(world, scene, name[..dot]) : [];
        return joints.Count == 0 ? null : $"{name[(dot + 1)..]} is no coordinate; {Moves([.. joints.SelectMany(FreeCoordinates).Distinct()])}.";
    }

    private static string Moves(Coordinate[] free) => free.Length == 0 ? "the joint moves nowhere" : $"the joint has {Listed(free)}";

    private static string Listed(Coordinate[] free) => string.Join(", ", free.Select(c => c.ToJson()));

    private static string? Drive(WorldJoint joint, Coordinate? given, double value, bool isSpeed)
    {
        Coordinate[] free = FreeCoordinates(joint);
        if (given is null && free.Length != 1)
            return free.Length == 0 ? "the joint moves nowhere." : $"say which coordinate: {Listed(free)}.";
        Coordinate coordinate = given ?? free[0];
        if (!free.Contains(coordinate))
            return $"the joint does not move along {coordinate.ToJson()}; {Moves(free)}.";
        if (isSpeed)
            joint.DriveAt(coordinate, value);
        else
            joint.DriveTo(coordinate, value);
        return null;
    }

    /// <summary>The coordinates that a joint leaves free or limited.</summary>
    internal static Coordinate[] FreeCoordinates(WorldJoint joint) => joint switch
    {
        WorldHingeJoint => [Coordinate.Angle],
        WorldConfigurableJoint configurable => Free(configurable.Settings),
        _ => [],
    };

    private static Coordinate[] Free(ConfigurableJoint joint)
    {
        (Coordinate Coordinate, ConfigurableJointMotion Motion)[] all =
        [
            (Coordinate.X, joint.XMotion),
            (Coordinate.Y, joint.YMotion),
            (Coordinate.Z, joint.ZMotion),
            (Coordinate.AngularX, joint.AngularXMotion),
            (Coordinate.AngularY, joint.AngularYMotion),
            (Coordinate.AngularZ, joint.AngularZMotion),
        ];
        return all.Where(a => a.Motion != ConfigurableJointMotion.Locked).Select(a => a.Coordinate).ToArray();
    }
}
