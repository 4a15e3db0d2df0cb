using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics.Articulations;
using Kinefab.Validation;

namespace Kinefab.Dynamics;

/// <summary>What a scene asks for that the exact solver has no meaning for.</summary>
internal static class ExactSolverCheck
{
    // One joint that sees other masses than the next has no energy to keep: J M^-1 J^T would not be symmetric across joints.
    public static List<Diagnostic> Of(ValidScene scene)
    {
        var found = new List<Diagnostic>();
        IReadOnlyList<GameObject> objects = scene.Document.GameObjects;
        for (int i = 0; i < objects.Count; i++)
        {
            for (int c = 0; c < objects[i].Components.Count; c++)
            {
                if (objects[i].Components[c] is Joint { Enabled: true } joint && HasMassScales(joint))
                {
                    found.Add(Diagnostic.Of(DiagnosticCodes.MassScaleIgnored, $"/gameObjects/{Text(i)}/components/{Text(c)}", MassScales(joint)));
                }
                else if (objects[i].Components[c] is ArticulationBody link && !scene.IsRootLink(i) && LeftOut(link) is string what)
                {
                    found.Add(Diagnostic.Of(DiagnosticCodes.LinkNotExact, $"/gameObjects/{Text(i)}/components/{Text(c)}", ("what", what), ("object", objects[i].Id)));
                }
            }
        }

        return found;
    }

    /// <summary>Whether a joint is to see other masses than its bodies have.</summary>
    public static bool HasMassScales(Joint joint) => joint.MassScale != 1 || joint.ConnectedMassScale != 1;

    /// <summary>What <see cref="DiagnosticCodes.MassScaleIgnored"/> names of it.</summary>
    public static (string Name, string Value)[] MassScales(Joint joint) => new[] { ("own", Text(joint.MassScale)), ("connected", Text(joint.ConnectedMassScale)) };

    // Joint friction has no law that keeps energy's account; a swing's limits are a cone that is alike on both sides.
    private static string? LeftOut(ArticulationBody link)
    {
        var what = new List<string>();
        if (link.JointFriction > 0 && link.JointType != ArticulationJointType.Fixed)
            what.Add("jointFriction");
        if (link.MaxJointVelocity is not null)
            what.Add("maxJointVelocity");
        if (link.JointType == ArticulationJointType.Spherical && (Lopsided(link.SwingYLock, link.YDrive) || Lopsided(link.SwingZLock, link.ZDrive)))
            what.Add("the nearer of two swing limits that are not alike");
        if (link.JointType == ArticulationJointType.Spherical && (Pulls(link, 0, link.XDrive) || Pulls(link, 1, link.YDrive) || Pulls(link, 2, link.ZDrive)))
            what.Add("the angles of a ball's drives, whose sines it follows,");
        if (Enumerable.Range(0, 3).Any(axis => IsScaled(link, axis)))
            what.Add("the whole articulation's inertia in the acceleration drives");
        return what.Count > 0 ? string.Join(", ", what) : null;
    }

    // An articulation scales them by the inertia that the axis sees with all links hung on it, a joint by that of its two bodies.
    private static bool IsScaled(ArticulationBody link, int axis)
    {
        LinkAxis own = ArticulationModel.Axis(link, axis);
        bool isOfJoint = link.JointType == ArticulationJointType.Spherical || (axis == 0 && link.JointType != ArticulationJointType.Fixed);
        return isOfJoint && own.IsAcceleration && own.HasDrive && own.Motion != LinkMotion.Locked;
    }

    private static bool Pulls(ArticulationBody link, int axis, ArticulationDrive drive) =>
        LinkJoint.TurnMotion(link, axis) != ConfigurableJointMotion.Locked && drive.DriveType != ArticulationDriveType.Velocity && (drive.Stiffness > 0 || drive.DriveType == ArticulationDriveType.Target);

    private static bool Lopsided(ConfigurableJointMotion motion, ArticulationDrive drive) => motion == ConfigurableJointMotion.Limited && drive.LowerLimit != -drive.UpperLimit;

    private static string Text(double number) => number.ToString(CultureInfo.InvariantCulture);
}
