using System;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>
/// The joint of a link as a joint component that leaves the same freedoms: for all that asks joints for their names, freedoms and rows.
/// Its bodies are swapped, so that limits and targets are those of the link against the one above it, as its drives have them.
/// </summary>
internal static class LinkJoint
{
    private const double Radians = Math.PI / 180;

    // The stiffest drive that PhysX 4.1 makes of the types Target and Velocity is 1e25 times as stiff as 1; in double precision this is as rigid.
    private const double Rigid = 1e9;

    /// <summary>Of a GameObject's link; null for a root, and without one.</summary>
    public static Joint? Of(SceneDocument document, HierarchyPlaces places, int gameObject)
    {
        ArticulationBody? link = document.GameObjects[gameObject].Link;
        return link is not null && places.LinkAbove(gameObject) is int parent ? Of(link, parent) : null;
    }

    /// <summary>How far a slide's frame stands along X so that its limits lie alike on both sides; metres.</summary>
    public static double Middle(ArticulationBody link) =>
        link is { JointType: ArticulationJointType.Prismatic, LinearLock: ConfigurableJointMotion.Limited } ? (link.XDrive.LowerLimit + link.XDrive.UpperLimit) / 2 : 0;

    public static ConfigurableJointMotion SlideMotion(ArticulationBody link) => Moving(link.JointType == ArticulationJointType.Prismatic, link.LinearLock);

    /// <summary>Motion about X, Y or Z.</summary>
    public static ConfigurableJointMotion TurnMotion(ArticulationBody link, int axis) => link.JointType switch
    {
        ArticulationJointType.Revolute => axis == 0 ? Moving(true, link.TwistLock) : ConfigurableJointMotion.Locked,
        ArticulationJointType.Spherical => axis == 0 ? link.TwistLock : axis == 1 ? link.SwingYLock : link.SwingZLock,
        _ => ConfigurableJointMotion.Locked,
    };

    /// <summary>The joint to the link of an object above.</summary>
    public static ConfigurableJoint Of(ArticulationBody link, int parent)
    {
        double middle = Middle(link);
        Vector3d x = link.AnchorRotation.Normalized() * Vector3d.UnitX;
        Vector3d slide = link.ParentAnchorRotation.Normalized() * Vector3d.UnitX;
        bool slides = link.JointType == ArticulationJointType.Prismatic;
        ConfigurableJointMotion twist = TurnMotion(link, 0);
        ArticulationDrive drive = link.XDrive;
        double swingY = Swing(link.YDrive), swingZ = Swing(link.ZDrive);
        return new ConfigurableJoint
        {
            ConnectedBody = parent,
            SwapBodies = true,
            Anchor = link.AnchorPosition,
            Axis = x,
            SecondaryAxis = link.AnchorRotation.Normalized() * Vector3d.UnitY,
            AutoConfigureConnectedAnchor = false,
            ConnectedAnchor = link.ParentAnchorPosition + slide * middle,
            XMotion = SlideMotion(link),
            AngularXMotion = twist,
            AngularYMotion = TurnMotion(link, 1),
            AngularZMotion = TurnMotion(link, 2),
            YMotion = ConfigurableJointMotion.Locked,
            ZMotion = ConfigurableJointMotion.Locked,
            LinearLimit = new SoftJointLimit { Limit = slides && link.LinearLock == ConfigurableJointMotion.Limited ? Math.Abs(drive.UpperLimit - drive.LowerLimit) / 2 : 0 },
            LowAngularXLimit = new SoftJointLimit { Limit = slides ? 0 : drive.LowerLimit },
            HighAngularXLimit = new SoftJointLimit { Limit = slides ? 0 : drive.UpperLimit },
            AngularYLimit = new SoftJointLimit { Limit = swingY },
            AngularZLimit = new SoftJointLimit { Limit = swingZ },
            XDrive = slides ? Drive(drive) : JointDrive.Default,
            AngularXDrive = slides ? JointDrive.Default : Drive(drive),
            AngularYZDrive = Drive(link.YDrive.IsActive ? link.YDrive : link.ZDrive),
            TargetPosition = new Vector3d(slides ? drive.Target - middle : 0, 0, 0),
            TargetVelocity = new Vector3d(slides ? drive.TargetVelocity : 0, 0, 0),
            TargetRotation = slides ? Quaterniond.Identity : Target(link),
            TargetAngularVelocity = slides ? Vector3d.Zero : new Vector3d(-drive.TargetVelocity, -link.YDrive.TargetVelocity, -link.ZDrive.TargetVelocity) * Radians,
            Because = link.Because,
            ExtrasJson = link.ExtrasJson,
        };
    }

    private static ConfigurableJointMotion Moving(bool isMine, ConfigurableJointMotion lockOf) =>
        !isMine ? ConfigurableJointMotion.Locked : lockOf == ConfigurableJointMotion.Limited ? lockOf : ConfigurableJointMotion.Free;

    private static double Swing(ArticulationDrive drive) => Math.Max(Math.Abs(drive.LowerLimit), Math.Abs(drive.UpperLimit));

    private static JointDrive Drive(ArticulationDrive drive) => drive.DriveType switch
    {
        ArticulationDriveType.Target => new JointDrive { PositionSpring = Rigid, PositionDamper = Rigid / 10, MaximumForce = drive.ForceLimit, UseAcceleration = true },
        ArticulationDriveType.Velocity => new JointDrive { PositionDamper = Rigid, MaximumForce = drive.ForceLimit, UseAcceleration = true },
        _ => new JointDrive
        {
            PositionSpring = drive.Stiffness,
            PositionDamper = drive.Damping,
            MaximumForce = drive.ForceLimit,
            UseAcceleration = drive.DriveType == ArticulationDriveType.Acceleration,
        },
    };

    private static Quaterniond Target(ArticulationBody link)
    {
        var turn = new Vector3d(
            TurnMotion(link, 0) == ConfigurableJointMotion.Locked ? 0 : link.XDrive.Target,
            TurnMotion(link, 1) == ConfigurableJointMotion.Locked ? 0 : link.YDrive.Target,
            TurnMotion(link, 2) == ConfigurableJointMotion.Locked ? 0 : link.ZDrive.Target);
        double angle = turn.Length;
        return angle > 0 ? Quaterniond.AxisAngle(turn * (1 / angle), angle * Radians) : Quaterniond.Identity;
    }
}
