using System;
using Kinefab.Document;
using Kinefab.Joints;
using Kinefab.Numerics;
using Document = Kinefab.Document;

namespace Kinefab.Mechanisms;

/// <summary>
/// Unity's joint fields in PhysX's terms. This is the only place that knows Unity's signs.
/// Actor 0 is the own body, actor 1 the connected one; swapBodies exchanges them. PhysX measures c, actor 1 in actor 0.
/// A ConfigurableJoint's fields mean c itself, so they pass as they are, inverted to whoever watches the own body.
/// A HingeJoint's mean the own body against the connected one, so they change sign.
/// </summary>
internal static class UnityJoints
{
    private const double Radians = Math.PI / 180;

    // PhysX's own choices (PxJointLimit.h): for a contactDistance of 0, which asks for the defaults (ScriptReference,
    // JointLimits.contactDistance), and for the bounce threshold that Unity's SoftJointLimit does not have (unconfirmed).
    private const double AngularContactDistance = 0.1;
    private const double AngularContactShare = 0.49;
    private const double LinearContactDistance = 0.01;
    private const double AngularBounceThreshold = 0.5;
    private const double LinearBounceThreshold = 0;

    /// <summary>A PhysX joint for a component, without bodies and frames.</summary>
    public static Kinefab.Joints.JointModel Create(Document.Joint settings)
    {
        switch (settings)
        {
            case HingeJoint hinge:
                var revolute = new RevoluteJoint();
                Apply(hinge, revolute);
                return revolute;
            case ConfigurableJoint configurable:
                var d6 = new D6Joint();
                Apply(configurable, d6);
                return d6;
            default:
                var fixedJoint = new D6Joint();
                Common(settings, fixedJoint, swap: false);
                return fixedJoint;
        }
    }

    /// <summary>HingeJoint: phi, the own body's angle about the axis, is minus the twist of c.</summary>
    public static void Apply(HingeJoint hinge, RevoluteJoint joint)
    {
        Common(hinge, joint, swap: false);
        joint.ExtendedLimits = hinge.ExtendedLimits;

        JointLimits limits = hinge.Limits;
        joint.LimitEnabled = hinge.UseLimits;
        joint.Limit = new AngularLimit
        {
            Lower = -hinge.Cut(limits.Max) * Radians,
            Upper = -hinge.Cut(limits.Min) * Radians,
            Response = new LimitResponse
            {
                Restitution = limits.Bounciness,
                BounceThreshold = limits.BounceMinVelocity * Radians,
                ContactDistance = AngularContact(limits.ContactDistance * Radians, (limits.Max - limits.Min) * Radians),
            },
        };

        // A motor without force is off, but still keeps the spring out.
        joint.MotorEnabled = hinge.UseMotor;
        joint.MotorVelocity = -hinge.Motor.TargetVelocity * Radians;
        joint.MotorForceLimit = hinge.Motor.Force;
        joint.MotorFreeSpin = hinge.Motor.FreeSpin;

        joint.Spring = hinge.UseSpring
            ? new Kinefab.Joints.DriveModel
            {
                Stiffness = hinge.Spring.Spring,
                Damping = hinge.Spring.Damper,
                ForceLimit = double.PositiveInfinity,
                IsAcceleration = hinge.UseAcceleration,
            }
            : default;
        joint.SpringTarget = -hinge.Spring.TargetPosition * Radians;
    }

    /// <summary>ConfigurableJoint: limits and targets are those of c.</summary>
    public static void Apply(ConfigurableJoint settings, D6Joint joint)
    {
        Common(settings, joint, settings.SwapBodies);
        joint.X = Motion(settings.XMotion);
        joint.Y = Motion(settings.YMotion);
        joint.Z = Motion(settings.ZMotion);
        joint.Twist = Motion(settings.AngularXMotion);
        joint.Swing1 = Motion(settings.AngularYMotion);
        joint.Swing2 = Motion(settings.AngularZMotion);
        Limits(settings, joint);

        joint.DriveX = Drive(settings.XDrive);
        joint.DriveY = Drive(settings.YDrive);
        joint.DriveZ = Drive(settings.ZDrive);
        bool slerp = settings.RotationDriveMode == RotationDriveMode.Slerp;
        joint.DriveSlerp = slerp ? Drive(settings.SlerpDrive) : default;
        joint.DriveTwist = slerp ? default : Drive(settings.AngularXDrive);
        joint.DriveSwing = slerp ? default : Drive(settings.AngularYZDrive);
        joint.DrivePose = new Pose(settings.TargetPosition, settings.TargetRotation.Normalized());
        joint.DriveLinearVelocity = settings.TargetVelocity;
        joint.DriveAngularVelocity = settings.TargetAngularVelocity;

        joint.Projection = settings.ProjectionMode == JointProjectionMode.PositionAndRotation;
        joint.ProjectionLinearTolerance = settings.ProjectionDistance;
        joint.ProjectionAngularTolerance = settings.ProjectionAngle * Radians;
    }

    /// <summary>Sign of a coordinate of the own body against the connected one, as SPEC.md names them, on c.</summary>
    public static double CoordinateSign(Document.Joint settings) => settings is ConfigurableJoint { SwapBodies: true } ? 1 : -1;

    private static void Limits(ConfigurableJoint settings, D6Joint joint)
    {
        double linearContact = settings.LinearLimit.ContactDistance;
        joint.LinearLimit = new Kinefab.Joints.LinearLimit
        {
            Value = settings.LinearLimit.Limit,
            Response = Response(
                settings.LinearLimit, settings.LinearLimitSpring, LinearBounceThreshold, linearContact > 0 ? linearContact : LinearContactDistance),
        };

        // One response serves both ends: PhysX keeps one for the pair. Unity's own choice is unconfirmed; the upper end's is taken, and
        // Y's for both swings. LIMIT_RESPONSE_SHARED names what is not used.
        SoftJointLimit low = settings.LowAngularXLimit;
        SoftJointLimit high = settings.HighAngularXLimit;
        joint.TwistLimit = new AngularLimit
        {
            Lower = low.Limit * Radians,
            Upper = high.Limit * Radians,
            Response = Response(
                high, settings.AngularXLimitSpring, AngularBounceThreshold, AngularContact(high.ContactDistance * Radians, (high.Limit - low.Limit) * Radians)),
        };

        SoftJointLimit y = settings.AngularYLimit;
        SoftJointLimit z = settings.AngularZLimit;
        joint.SwingLimit = new ConeLimit
        {
            Y = Math.Max(ConeLimit.LeastAngle, y.Limit * Radians),
            Z = Math.Max(ConeLimit.LeastAngle, z.Limit * Radians),
            Response = Response(
                y, settings.AngularYZLimitSpring, AngularBounceThreshold, AngularContact(y.ContactDistance * Radians, Math.Min(y.Limit, z.Limit) * Radians)),
        };
    }

    private static void Common(Document.Joint settings, Kinefab.Joints.JointModel joint, bool swap)
    {
        joint.BreakForce = settings.BreakForce;
        joint.BreakTorque = settings.BreakTorque;
        joint.Preprocessing = settings.EnablePreprocessing;
        double scale0 = swap ? settings.ConnectedMassScale : settings.MassScale;
        double scale1 = swap ? settings.MassScale : settings.ConnectedMassScale;
        joint.InverseMassScale0 = scale0;
        joint.InverseInertiaScale0 = scale0;
        joint.InverseMassScale1 = scale1;
        joint.InverseInertiaScale1 = scale1;
    }

    private static LimitResponse Response(SoftJointLimit limit, SoftJointLimitSpring spring, double bounceThreshold, double contactDistance) => new()
    {
        Stiffness = spring.Spring,
        Damping = spring.Damper,
        Restitution = limit.Bounciness,
        BounceThreshold = bounceThreshold,
        ContactDistance = contactDistance,
    };

    private static double AngularContact(double given, double range) =>
        given > 0 ? given : Math.Min(AngularContactDistance, AngularContactShare * Math.Max(0, range));

    private static Kinefab.Joints.DriveModel Drive(Document.JointDrive drive) => new()
    {
        Stiffness = drive.PositionSpring,
        Damping = drive.PositionDamper,
        ForceLimit = drive.MaximumForce,
        IsAcceleration = drive.UseAcceleration,
    };

    private static AxisMotion Motion(ConfigurableJointMotion motion) => (AxisMotion)motion;
}
