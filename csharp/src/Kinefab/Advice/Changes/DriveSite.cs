using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Validation;

namespace Kinefab.Advice.Changes;

/// <summary>A drive, motor or hinge spring that acts: where it stands and what it moves.</summary>
internal sealed class DriveSite
{
    private DriveSite(WorldJoint joint, string place, string field, string label, Coordinate[] coordinates, double spring, double damper, double force)
    {
        Joint = joint;
        Place = place;
        Field = field;
        Label = label;
        Coordinates = coordinates;
        Spring = spring;
        Damper = damper;
        Force = force;
    }

    public WorldJoint Joint { get; }

    /// <summary>The joint in words.</summary>
    public string Place { get; }

    /// <summary>Its field in the component.</summary>
    public string Field { get; }

    /// <summary>Its name in the Inspector.</summary>
    public string Label { get; }

    /// <summary>The joint's coordinates that it acts on.</summary>
    public Coordinate[] Coordinates { get; }

    /// <summary>0: it only drives a speed.</summary>
    public double Spring { get; }

    public double Damper { get; }

    /// <summary>N or N m; infinite: unlimited.</summary>
    public double Force { get; }

    public bool IsAngular => Coordinates[0] is Coordinate.Angle or >= Coordinate.AngularX;

    public string Pointer => $"{EditText.Pointer(Joint)}/{Field}";

    /// <summary>The same drive with another largest force.</summary>
    public ChangePart WithForce(double force)
    {
        (string field, string word) = Joint is WorldHingeJoint ? ("force", "Force") : Joint is WorldLinkJoint ? ("forceLimit", "Force Limit") : ("maximumForce", "Maximum Force");
        string value = EditText.Number(force);
        return new ChangePart(Joint.GameObject, $"{Label} > {word} {EditText.Number(Force)} -> {value}", Place, new SceneEdit($"{Pointer}/{field}", value));
    }

    /// <summary>The same drive with another damper.</summary>
    public ChangePart WithDamper(double damper)
    {
        (string field, string word) = Joint is WorldHingeJoint ? ("damper", "Damper") : Joint is WorldLinkJoint ? ("damping", "Damping") : ("positionDamper", "Position Damper");
        string value = EditText.Number(damper);
        return new ChangePart(Joint.GameObject, $"{Label} > {word} {EditText.Number(Damper)} -> {value}", Place, new SceneEdit($"{Pointer}/{field}", value));
    }

    /// <summary>All that act in a scene.</summary>
    public static IEnumerable<DriveSite> Of(ValidScene scene, World world)
    {
        foreach (WorldJoint joint in world.Joints)
        {
            string place = JointSettings.Place(scene, joint);
            if (joint is WorldLinkJoint link)
            {
                foreach (DriveSite site in Of(link, place))
                    yield return site;
                continue;
            }

            switch (JointSettings.Of(scene, joint))
            {
                case HingeJoint { UseMotor: true } hinge when hinge.Motor.Force > 0:
                    yield return new DriveSite(joint, place, "motor", "Motor", new[] { Coordinate.Angle }, 0, 0, hinge.Motor.Force);
                    break;
                case HingeJoint { UseMotor: false, UseSpring: true } hinge when hinge.Spring.Spring > 0:
                    yield return new DriveSite(
                        joint, place, "spring", "Spring", new[] { Coordinate.Angle }, hinge.Spring.Spring, hinge.Spring.Damper, double.PositiveInfinity);
                    break;
                case ConfigurableJoint configurable:
                    foreach (DriveSite site in Of(joint, place, configurable))
                        yield return site;
                    break;
            }
        }
    }

    // Those of the types Target and Velocity have no gains to change.
    private static IEnumerable<DriveSite> Of(WorldLinkJoint joint, string place)
    {
        foreach (Coordinate coordinate in joint.FreeCoordinates)
        {
            (string field, string label, ArticulationDrive drive) = coordinate switch
            {
                Coordinate.AngularY => ("yDrive", "Y Drive", joint.Settings.YDrive),
                Coordinate.AngularZ => ("zDrive", "Z Drive", joint.Settings.ZDrive),
                _ => ("xDrive", "X Drive", joint.Settings.XDrive),
            };
            if (drive.DriveType is ArticulationDriveType.Force or ArticulationDriveType.Acceleration && drive.IsActive)
                yield return new DriveSite(joint, place, field, label, new[] { coordinate }, drive.Stiffness, drive.Damping, drive.ForceLimit);
        }
    }

    private static IEnumerable<DriveSite> Of(WorldJoint joint, string place, ConfigurableJoint c)
    {
        var all = new List<(string Field, string Label, JointDrive Drive, (Coordinate Axis, ConfigurableJointMotion Motion)[] Axes)>
        {
            ("xDrive", "X Drive", c.XDrive, new[] { (Coordinate.X, c.XMotion) }),
            ("yDrive", "Y Drive", c.YDrive, new[] { (Coordinate.Y, c.YMotion) }),
            ("zDrive", "Z Drive", c.ZDrive, new[] { (Coordinate.Z, c.ZMotion) }),
        };
        (Coordinate, ConfigurableJointMotion) x = (Coordinate.AngularX, c.AngularXMotion);
        (Coordinate, ConfigurableJointMotion) y = (Coordinate.AngularY, c.AngularYMotion);
        (Coordinate, ConfigurableJointMotion) z = (Coordinate.AngularZ, c.AngularZMotion);
        if (c.RotationDriveMode == RotationDriveMode.Slerp)
        {
            all.Add(("slerpDrive", "Slerp Drive", c.SlerpDrive, new[] { x, y, z }));
        }
        else
        {
            all.Add(("angularXDrive", "Angular X Drive", c.AngularXDrive, new[] { x }));
            all.Add(("angularYZDrive", "Angular YZ Drive", c.AngularYZDrive, new[] { y, z }));
        }

        foreach ((string field, string label, JointDrive drive, (Coordinate Axis, ConfigurableJointMotion Motion)[] axes) in all)
        {
            Coordinate[] free = axes.Where(a => a.Motion != ConfigurableJointMotion.Locked).Select(a => a.Axis).ToArray();
            if (free.Length > 0 && drive.IsActive)
                yield return new DriveSite(joint, place, field, label, free, drive.PositionSpring, drive.PositionDamper, drive.MaximumForce);
        }
    }
}
