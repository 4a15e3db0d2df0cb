using System;
using System.Collections.Generic;
using Kinefab.Document;

namespace Kinefab.Mechanisms;

/// <summary>
/// What the source calls a joint and how it counts its coordinates, as far as the file tells: the one place for either,
/// so that a field of a later format is read here alone.
/// </summary>
internal static class CadReading
{
    /// <summary>The user's own name for a joint, or for that of a link; null when the file does not tell it.</summary>
    public static string? Name(Component joint) => JointExtras.Name(joint);

    /// <summary>Constraints or joints of the source that a joint, or that of a link, stands for.</summary>
    public static IReadOnlyList<string> Sources(Component joint) => joint switch
    {
        Joint component => component.Because,
        ArticulationBody link => link.Because,
        _ => Array.Empty<string>(),
    };

    /// <summary>
    /// How a coordinate reads in the source: Sign times it, plus Offset in degrees or metres. Format 1.0 tells the sense of
    /// hinges, slides, and turns about the axis of a slide, and no offset: zero is the pose in the file.
    /// </summary>
    public static (double Sign, double Offset) Of(Joint joint, Coordinate coordinate) =>
        (joint is ConfigurableJoint configurable && !configurable.SwapBodies && IsAlikeFromBothSides(configurable) ? Sense(joint, coordinate) : 1, 0);

    // The axes are those of the CAD joint mirrored: Z is turned round, and turns are counted by the other hand.
    private static double Sense(Joint joint, Coordinate coordinate)
    {
        double sense = coordinate is Coordinate.X or Coordinate.Y or Coordinate.AngularZ ? 1 : -1;
        return JointExtras.CountsConnected(joint) ? -sense : sense;
    }

    // Slides alone, or a turn about the one that slides: either body counts the other's motion along the same axes.
    private static bool IsAlikeFromBothSides(ConfigurableJoint joint)
    {
        int slides = Free(joint.XMotion, 1) | Free(joint.YMotion, 2) | Free(joint.ZMotion, 4);
        int turns = Free(joint.AngularXMotion, 1) | Free(joint.AngularYMotion, 2) | Free(joint.AngularZMotion, 4);
        return slides != 0 && (turns == 0 || (turns == slides && (turns & (turns - 1)) == 0));
    }

    private static int Free(ConfigurableJointMotion motion, int bit) => motion == ConfigurableJointMotion.Locked ? 0 : bit;
}
