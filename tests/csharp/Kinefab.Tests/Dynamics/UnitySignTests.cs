using System;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>
/// Unity's signs, one test a row of SPEC.md's table. Expected motions are those of the own body against the connected one in the
/// left-hand sense, measured from the poses alone. Axis Z of the own body is the joint's X.
/// </summary>
[TestFixture(false)]
[TestFixture(true)]
public sealed class UnitySignTests(bool connected)
{
    private const ConfigurableJointMotion Locked = ConfigurableJointMotion.Locked;
    private const ConfigurableJointMotion Free = ConfigurableJointMotion.Free;
    private const ConfigurableJointMotion Limited = ConfigurableJointMotion.Limited;

    private static readonly JointDrive Strong = new() { PositionSpring = 400, PositionDamper = 60 };
    private static readonly JointDrive Damper = new() { PositionDamper = 1e5 };

    private int? Other => connected ? 1 : null;

    [TestCase(2.0, 80)]
    [TestCase(-2.0, -10)]
    public void Hinge_Limits_StopTheOwnBodyAtMinAndMax(double speed, double expected)
    {
        World world = Make(new HingeJoint
        {
            Axis = Vector3d.UnitZ,
            ConnectedBody = Other,
            UseLimits = true,
            Limits = new JointLimits { Min = -10, Max = 80 },
        });
        Spin(world, speed);

        SmallScene.Run(world, 2);

        Assert.That(SmallScene.Turn(world).Z, Is.EqualTo(expected).Within(1e-3));
        Assert.That(((WorldHingeJoint)world.Joints[0]).Angle, Is.EqualTo(expected).Within(1e-3));
    }

    [Test]
    public void Hinge_Motor_TurnsTheOwnBodyForward()
    {
        World world = Make(new HingeJoint
        {
            Axis = Vector3d.UnitZ,
            ConnectedBody = Other,
            UseMotor = true,
            Motor = new JointMotor { TargetVelocity = 50, Force = 1e6 },
        });

        SmallScene.Run(world, 1);

        Assert.That(SmallScene.Turn(world).Z, Is.EqualTo(50).Within(1e-3));
        Assert.That(((WorldHingeJoint)world.Joints[0]).Velocity, Is.EqualTo(50).Within(1e-3));
    }

    [Test]
    public void Hinge_SpringTarget_IsTheOwnBodysAngle()
    {
        World world = Make(new HingeJoint
        {
            Axis = Vector3d.UnitZ,
            ConnectedBody = Other,
            UseSpring = true,
            Spring = new JointSpring { Spring = 400, Damper = 60, TargetPosition = 35 },
        });

        SmallScene.Run(world, 3);

        Assert.That(SmallScene.Turn(world).Z, Is.EqualTo(35).Within(1e-3));
    }

    [TestCase(false, 2.0, 10)]
    [TestCase(false, -2.0, -80)]
    [TestCase(true, 2.0, 80)]
    [TestCase(true, -2.0, -10)]
    public void Configurable_AngularXLimits_AreInvertedUnlessSwapped(bool swap, double speed, double expected)
    {
        World world = Make(new ConfigurableJoint
        {
            Axis = Vector3d.UnitZ,
            ConnectedBody = Other,
            SwapBodies = swap,
            XMotion = Locked,
            YMotion = Locked,
            ZMotion = Locked,
            AngularXMotion = Limited,
            AngularYMotion = Locked,
            AngularZMotion = Locked,
            LowAngularXLimit = new SoftJointLimit { Limit = -10 },
            HighAngularXLimit = new SoftJointLimit { Limit = 80 },
        });
        Spin(world, speed);

        SmallScene.Run(world, 2);

        Assert.That(SmallScene.Turn(world).Z, Is.EqualTo(expected).Within(1e-3));
        Assert.That(world.Joints[0].Coordinate(Coordinate.AngularX), Is.EqualTo(expected).Within(1e-3));
    }

    [TestCase(2.0, 25)]
    [TestCase(-2.0, -25)]
    public void Configurable_AngularYLimit_IsSymmetric(double speed, double expected)
    {
        // The joint's Y is the own body's X here: secondaryAxis.
        World world = Make(new ConfigurableJoint
        {
            Axis = Vector3d.UnitZ,
            SecondaryAxis = Vector3d.UnitX,
            ConnectedBody = Other,
            XMotion = Locked,
            YMotion = Locked,
            ZMotion = Locked,
            AngularXMotion = Locked,
            AngularYMotion = Limited,
            AngularZMotion = Locked,
            AngularYLimit = new SoftJointLimit { Limit = 25 },
        });
        world.Bodies[0].AngularVelocity = SmallScene.OwnPose.Rotation * new Vector3d(speed, 0, 0);

        SmallScene.Run(world, 2);

        Assert.That(SmallScene.Turn(world).X, Is.EqualTo(expected).Within(1e-3));
    }

    [TestCase(false, -40)]
    [TestCase(true, 40)]
    public void Configurable_TargetRotation_IsInvertedUnlessSwapped(bool swap, double expected)
    {
        World world = Make(new ConfigurableJoint
        {
            Axis = Vector3d.UnitZ,
            ConnectedBody = Other,
            SwapBodies = swap,
            XMotion = Locked,
            YMotion = Locked,
            ZMotion = Locked,
            AngularYMotion = Locked,
            AngularZMotion = Locked,
            AngularXDrive = Strong,
            TargetRotation = Quaterniond.AxisAngle(Vector3d.UnitX, 40 * Math.PI / 180),
        });

        SmallScene.Run(world, 4);

        Assert.That(SmallScene.Turn(world).Z, Is.EqualTo(expected).Within(1e-3));
    }

    [TestCase(false, -0.2)]
    [TestCase(true, 0.2)]
    public void Configurable_TargetPosition_IsInvertedUnlessSwapped(bool swap, double expected)
    {
        World world = Make(Slider(swap, new Vector3d(0.2, 0, 0), Vector3d.Zero, Strong));

        SmallScene.Run(world, 4);

        Assert.That(SmallScene.Way(world).Z, Is.EqualTo(expected).Within(1e-5));
        Assert.That(world.Joints[0].Coordinate(Coordinate.X), Is.EqualTo(expected).Within(1e-5));
    }

    [TestCase(false, -0.3)]
    [TestCase(true, 0.3)]
    public void Configurable_TargetVelocity_IsInvertedUnlessSwapped(bool swap, double expected)
    {
        World world = Make(Slider(swap, Vector3d.Zero, new Vector3d(0.3, 0, 0), Damper));

        SmallScene.Run(world, 1);

        Assert.That(SmallScene.Way(world).Z, Is.EqualTo(expected).Within(1e-3));
    }

    [TestCase(RotationDriveMode.XYAndZ, false, 0.5)]
    [TestCase(RotationDriveMode.XYAndZ, true, -0.5)]
    [TestCase(RotationDriveMode.Slerp, false, -0.5)]
    [TestCase(RotationDriveMode.Slerp, true, 0.5)]
    public void Configurable_TargetAngularVelocity_IsInvertedWithSlerpOrSwapped(RotationDriveMode mode, bool swap, double expected)
    {
        World world = Make(new ConfigurableJoint
        {
            Axis = Vector3d.UnitZ,
            ConnectedBody = Other,
            SwapBodies = swap,
            XMotion = Locked,
            YMotion = Locked,
            ZMotion = Locked,
            RotationDriveMode = mode,
            AngularXDrive = Damper,
            AngularYZDrive = Damper,
            SlerpDrive = Damper,
            TargetAngularVelocity = new Vector3d(0.5, 0, 0),
        });

        SmallScene.Run(world, 1);

        Assert.That(SmallScene.Turn(world).Z * Math.PI / 180, Is.EqualTo(expected).Within(1e-3));
    }

    [TestCase(0.9, -0.6)]
    [TestCase(-0.2, 0.8)]
    public void Configurable_LinearLimit_IsOneRadiusForBothAxes(double x, double y)
    {
        World world = Make(new ConfigurableJoint
        {
            ConnectedBody = Other,
            XMotion = Limited,
            YMotion = Limited,
            ZMotion = Locked,
            AngularXMotion = Locked,
            AngularYMotion = Locked,
            AngularZMotion = Locked,
            LinearLimit = new SoftJointLimit { Limit = 0.25 },
        });
        world.Bodies[0].LinearVelocity = SmallScene.OwnPose.Rotation * new Vector3d(x, y, 0);

        SmallScene.Run(world, 2);

        Vector3d way = SmallScene.Way(world);
        double speed = Math.Sqrt(x * x + y * y);
        Assert.That(way.X, Is.EqualTo(0.25 * x / speed).Within(1e-5));
        Assert.That(way.Y, Is.EqualTo(0.25 * y / speed).Within(1e-5));
    }

    private ConfigurableJoint Slider(bool swap, Vector3d position, Vector3d velocity, JointDrive drive) => new()
    {
        Axis = Vector3d.UnitZ,
        ConnectedBody = Other,
        SwapBodies = swap,
        YMotion = Locked,
        ZMotion = Locked,
        AngularXMotion = Locked,
        AngularYMotion = Locked,
        AngularZMotion = Locked,
        XDrive = drive,
        TargetPosition = position,
        TargetVelocity = velocity,
    };

    private World Make(Joint joint) => SmallScene.Create(joint, connected: connected);

    private static void Spin(World world, double speed) => world.Bodies[0].AngularVelocity = SmallScene.OwnPose.Rotation * new Vector3d(0, 0, speed);
}
