using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Tests.Dynamics;
using Kinefab.Validation;

namespace Kinefab.Tests.UnityPackage;

/// <summary>A scene whose bodies, joints and colliders stand nowhere at a default of the format.</summary>
internal static class UnityImportScene
{
    private static readonly Vector3d Odd = new(0.25, -0.5, 0.75);

    private static readonly Quaterniond Turned = Quaterniond.AxisAngle(new Vector3d(1, 2, -2) * (1.0 / 3), 0.7);

    public static ValidScene EveryField() => SmallScene.Validate(new SceneDocument
    {
        Physics = new Physics
        {
            Gravity = new Vector3d(0.5, -1.62, 0.25),
            FixedTimestep = 0.01,
            SolverIterations = 12,
            SolverVelocityIterations = 3,
            BounceThreshold = 3,
            DefaultMaxAngularSpeed = 9,
        },
        PhysicsMaterials =
        [
            new PhysicsMaterial { Name = "Plain" },
            new PhysicsMaterial { Name = "Rubber", DynamicFriction = 0.7, StaticFriction = 0.9, Bounciness = 0.25, FrictionCombine = PhysicsMaterialCombine.Maximum, BounceCombine = PhysicsMaterialCombine.Multiply },
        ],
        GameObjects =
        [
            new GameObject { Id = "root", Name = "Root", Transform = Place(new Vector3d(2, 2, 2)) },
            new GameObject { Id = "root/own", Name = "Own", Parent = 0, Transform = Place(new Vector3d(1, 2, 3)), Components = [Body(), Hinge(), Configurable(), Fixed(), new HingeJoint { ConnectedBody = 2 }] },
            new GameObject { Id = "root/other", Name = "Other", Parent = 0, Transform = Place(new Vector3d(3, 2, 1)), Components = [Body(), .. Colliders()] },
            new GameObject { Id = "root/off", Name = "Off", Parent = 0, Active = false, Transform = Place(new Vector3d(1, 1, 2)), Components = [new Rigidbody { IsKinematic = true }] },
        ],
    });

    private static Transform Place(Vector3d scale) => new() { LocalPosition = Odd, LocalRotation = Turned, LocalScale = scale };

    private static Rigidbody Body() => new()
    {
        Mass = 3,
        LinearDamping = 0.1,
        AngularDamping = 0.2,
        CenterOfMass = Odd,
        InertiaTensor = new Vector3d(2, 3, 4),
        InertiaTensorRotation = Turned,
        UseGravity = false,
        IsKinematic = true,
        Interpolation = RigidbodyInterpolation.Extrapolate,
        Constraints = RigidbodyConstraints.FreezePositionY | RigidbodyConstraints.FreezeRotationZ,
        CollisionDetectionMode = CollisionDetectionMode.ContinuousSpeculative,
        MaxAngularVelocity = 11,
        SolverIterations = 13,
        SolverVelocityIterations = 4,
    };

    private static HingeJoint Hinge() => new()
    {
        ConnectedBody = 2,
        BreakForce = 100,
        BreakTorque = 10,
        EnableCollision = true,
        EnablePreprocessing = false,
        MassScale = 2,
        ConnectedMassScale = 3,
        Anchor = Odd,
        Axis = new Vector3d(0, 3, 4),
        AutoConfigureConnectedAnchor = false,
        ConnectedAnchor = new Vector3d(1, 2, 3),
        UseSpring = true,
        Spring = new JointSpring { Spring = 5, Damper = 6, TargetPosition = 7 },
        UseMotor = true,
        Motor = new JointMotor { TargetVelocity = 8, Force = 9, FreeSpin = true },
        UseLimits = true,
        Limits = new JointLimits { Min = -200, Max = 20, Bounciness = 0.3, BounceMinVelocity = 0.4, ContactDistance = 0.5 },
        ExtendedLimits = true,
        UseAcceleration = true,
    };

    private static ConfigurableJoint Configurable() => new()
    {
        ConnectedBody = 2,
        BreakForce = 101,
        BreakTorque = 11,
        EnableCollision = true,
        EnablePreprocessing = false,
        MassScale = 2,
        ConnectedMassScale = 3,
        Anchor = Odd,
        Axis = new Vector3d(0, 3, 4),
        AutoConfigureConnectedAnchor = false,
        ConnectedAnchor = new Vector3d(1, 2, 3),
        SecondaryAxis = new Vector3d(1, 0, 1),
        XMotion = ConfigurableJointMotion.Limited,
        YMotion = ConfigurableJointMotion.Locked,
        ZMotion = ConfigurableJointMotion.Limited,
        AngularXMotion = ConfigurableJointMotion.Limited,
        AngularYMotion = ConfigurableJointMotion.Limited,
        AngularZMotion = ConfigurableJointMotion.Limited,
        LinearLimitSpring = Softness(1),
        LinearLimit = Limit(0.2),
        AngularXLimitSpring = Softness(3),
        LowAngularXLimit = Limit(-15),
        HighAngularXLimit = Limit(25),
        AngularYZLimitSpring = Softness(5),
        AngularYLimit = Limit(35),
        AngularZLimit = Limit(45),
        TargetPosition = new Vector3d(0.01, 0.02, 0.03),
        TargetVelocity = new Vector3d(0.4, 0.5, 0.6),
        XDrive = Drive(10),
        YDrive = Drive(20),
        ZDrive = Drive(30),
        TargetRotation = Turned,
        TargetAngularVelocity = new Vector3d(0.7, 0.8, 0.9),
        RotationDriveMode = RotationDriveMode.Slerp,
        AngularXDrive = Drive(40),
        AngularYZDrive = Drive(50),
        SlerpDrive = Drive(60),
        ProjectionMode = JointProjectionMode.PositionAndRotation,
        ProjectionDistance = 0.02,
        ProjectionAngle = 17,
        ConfiguredInWorldSpace = true,
        SwapBodies = true,
    };

    private static FixedJoint Fixed() => new()
    {
        ConnectedBody = 2,
        BreakForce = 102,
        BreakTorque = 12,
        EnableCollision = true,
        EnablePreprocessing = false,
        MassScale = 4,
        ConnectedMassScale = 5,
    };

    private static Component[] Colliders() =>
    [
        new BoxCollider { Center = Odd, Size = new Vector3d(1, 2, 3), IsTrigger = true, Enabled = false, Material = 1 },
        new SphereCollider { Center = Odd, Radius = 0.7, IsTrigger = true, Enabled = false, Material = 1 },
        new CapsuleCollider { Center = Odd, Radius = 0.3, Height = 1.5, Direction = Axis.Z, IsTrigger = true, Enabled = false, Material = 1 },
    ];

    private static SoftJointLimit Limit(double limit) => new() { Limit = limit, Bounciness = 0.25, ContactDistance = 0.125 };

    private static SoftJointLimitSpring Softness(double spring) => new() { Spring = spring, Damper = spring + 1 };

    private static JointDrive Drive(double spring) => new() { PositionSpring = spring, PositionDamper = spring + 1, MaximumForce = spring + 2, UseAcceleration = true };
}
