using System;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Mechanisms;

/// <summary>What a joint's component lets a link do, as an ArticulationBody says it.</summary>
internal static class LinkFreedoms
{
    private const double Degrees = 180 / Math.PI;

    // N m s/rad of the drive that stands for a motor: its force is then the motor's largest.
    private const double MotorDamping = 1e7;

    private const ConfigurableJointMotion Locked = ConfigurableJointMotion.Locked;

    /// <summary>Type, locks and drives.</summary>
    /// <param name="link">Of the body.</param>
    /// <param name="joint">Between it and the link above.</param>
    /// <param name="start">Metres by which a slide stands out at the exported pose.</param>
    /// <param name="moving">The link as it moves; null where it cannot.</param>
    /// <returns>Why no link moves so; null: it does.</returns>
    internal static string? Set(ArticulationBody link, Joint joint, double start, out ArticulationBody? moving)
    {
        moving = null;
        if (joint.BreakForce < double.PositiveInfinity || joint.BreakTorque < double.PositiveInfinity)
            return "it can break";
        if (joint is HingeJoint hinge)
        {
            ConfigurableJointMotion twist = hinge.UseLimits ? ConfigurableJointMotion.Limited : ConfigurableJointMotion.Free;
            moving = link with { JointType = ArticulationJointType.Revolute, TwistLock = twist, XDrive = Hinge(hinge) };
            return null;
        }

        if (joint is not ConfigurableJoint free)
        {
            moving = link;
            return null;
        }

        bool slides = free.XMotion != Locked, slidesAside = free.YMotion != Locked || free.ZMotion != Locked;
        bool turns = free.AngularXMotion != Locked || free.AngularYMotion != Locked || free.AngularZMotion != Locked;
        if (slidesAside || (slides && turns))
            return "an articulation has revolute, prismatic, spherical and fixed joints only";
        if (slides)
            moving = link with { JointType = ArticulationJointType.Prismatic, LinearLock = free.XMotion, XDrive = Slide(free, start) };
        else if (!turns)
            moving = link;
        else
            return Turn(link, free, out moving);
        return null;
    }

    // Counted from the exported pose: the component counts from where its anchors meet.
    private static ArticulationDrive Slide(ConfigurableJoint joint, double start)
    {
        double sense = joint.SwapBodies ? 1 : -1;
        bool isLimited = joint.XMotion == ConfigurableJointMotion.Limited;
        double reach = joint.LinearLimit.Limit;
        return Driven(joint.XDrive, sense * joint.TargetPosition.X - start, sense * joint.TargetVelocity.X) with
        {
            LowerLimit = isLimited ? -reach - start : 0,
            UpperLimit = isLimited ? reach - start : 0,
        };
    }

    private static ArticulationDrive Hinge(HingeJoint joint)
    {
        var drive = new ArticulationDrive { LowerLimit = joint.UseLimits ? joint.Limits.Min : 0, UpperLimit = joint.UseLimits ? joint.Limits.Max : 0 };
        if (joint.UseMotor)
            return drive with { Damping = MotorDamping, ForceLimit = joint.Motor.Force, TargetVelocity = joint.Motor.TargetVelocity };
        if (!joint.UseSpring)
            return drive;
        return drive with { Stiffness = joint.Spring.Spring, Damping = joint.Spring.Damper, Target = joint.Spring.TargetPosition, DriveType = Kind(joint.UseAcceleration) };
    }

    // A ConfigurableJoint limits and drives the connected body's twist, unless the bodies are swapped; a link turns itself.
    private static string? Turn(ArticulationBody link, ConfigurableJoint joint, out ArticulationBody? moving)
    {
        moving = null;
        double sense = joint.SwapBodies ? 1 : -1;
        double low = sense * joint.LowAngularXLimit.Limit, high = sense * joint.HighAngularXLimit.Limit;
        bool slerp = joint.RotationDriveMode == RotationDriveMode.Slerp;
        Quaterniond turn = joint.TargetRotation;
        Vector3d speed = joint.TargetAngularVelocity;
        bool aimsAside = turn.Y != 0 || turn.Z != 0 || speed.Y != 0 || speed.Z != 0;
        if (aimsAside || (slerp && (turn.X != 0 || speed.X != 0)))
            return "its drive turns about several axes to a target";
        double target = sense * 2 * Trigonometry.Atan2(turn.X, turn.W) * Degrees;
        ArticulationDrive twist = Driven(slerp ? joint.SlerpDrive : joint.AngularXDrive, target, -sense * speed.X * Degrees) with
        {
            LowerLimit = Math.Min(low, high),
            UpperLimit = Math.Max(low, high),
        };
        link = link with { TwistLock = joint.AngularXMotion, XDrive = twist };
        if (joint.AngularYMotion == Locked && joint.AngularZMotion == Locked)
        {
            moving = link with { JointType = ArticulationJointType.Revolute };
            return null;
        }

        ArticulationDrive swing = Driven(slerp ? joint.SlerpDrive : joint.AngularYZDrive, 0, 0);
        moving = link with
        {
            JointType = ArticulationJointType.Spherical,
            SwingYLock = joint.AngularYMotion,
            SwingZLock = joint.AngularZMotion,
            YDrive = swing with { LowerLimit = -joint.AngularYLimit.Limit, UpperLimit = joint.AngularYLimit.Limit },
            ZDrive = swing with { LowerLimit = -joint.AngularZLimit.Limit, UpperLimit = joint.AngularZLimit.Limit },
        };
        return null;
    }

    private static ArticulationDrive Driven(JointDrive drive, double target, double velocity) => new()
    {
        Stiffness = drive.PositionSpring,
        Damping = drive.PositionDamper,
        ForceLimit = drive.MaximumForce,
        Target = drive.PositionSpring != 0 ? target : 0,
        TargetVelocity = velocity,
        DriveType = Kind(drive.UseAcceleration),
    };

    private static ArticulationDriveType Kind(bool accelerates) => accelerates ? ArticulationDriveType.Acceleration : ArticulationDriveType.Force;
}
