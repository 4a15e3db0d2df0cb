using System;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>
/// A ConfigurableJoint's targets along all three axes at once, none of them a world or body axis by chance. With axis Z and
/// secondaryAxis Y the joint's x, y, z are the own body's Z, Y, -X.
/// </summary>
[TestFixture(false)]
[TestFixture(true)]
public sealed class UnityTargetTests(bool connected)
{
    private static readonly JointDrive Strong = new() { PositionSpring = 400, PositionDamper = 60 };
    private static readonly JointDrive Damper = new() { PositionDamper = 1e5 };
    private static readonly Vector3d Target = new(0.1, 0.2, 0.3);

    private int? Other => connected ? 1 : null;

    [TestCase(false)]
    [TestCase(true)]
    public void TargetPosition_ThreeAxes_IsWhereTheConnectedAnchorStands(bool swap)
    {
        World world = Make(swap: swap, position: Target, linear: Strong);

        SmallScene.Run(world, 4);

        Assert.That((SmallScene.Way(world) - Own(Target) * (swap ? 1 : -1)).Length, Is.LessThan(1e-5));
    }

    [TestCase(false)]
    [TestCase(true)]
    public void TargetVelocity_ThreeAxes_IsTheConnectedBodys(bool swap)
    {
        World world = Make(swap: swap, velocity: Target, linear: Damper);

        SmallScene.Run(world, 1);

        Assert.That((SmallScene.Way(world) - Own(Target) * (swap ? 1 : -1)).Length, Is.LessThan(1e-3));
    }

    [TestCase(RotationDriveMode.XYAndZ, false)]
    [TestCase(RotationDriveMode.XYAndZ, true)]
    [TestCase(RotationDriveMode.Slerp, false)]
    [TestCase(RotationDriveMode.Slerp, true)]
    public void TargetRotation_AnyAxis_IsTheConnectedBodysRotation(RotationDriveMode mode, bool swap)
    {
        var axis = new Vector3d(1.0 / 3, 2.0 / 3, 2.0 / 3);
        World world = Make(swap: swap, rotation: Quaterniond.AxisAngle(axis, 40 * Math.PI / 180), angular: Strong, mode: mode);

        SmallScene.Run(world, 8);

        Assert.That((SmallScene.Turn(world) - Own(axis) * (swap ? 40 : -40)).Length, Is.LessThan(1e-2));
    }

    [Test]
    public void ConfiguredInWorldSpace_TargetPosition_IsAlongTheWorldsAxes()
    {
        // Axis and secondaryAxis are the world's Z and Y, and so are those of the target.
        World world = Make(position: Target, linear: Strong, inWorld: true);

        SmallScene.Run(world, 4);

        Vector3d way = world.Bodies[0].Pose.Position - SmallScene.OwnPose.Position;
        Assert.That((way + Own(Target)).Length, Is.LessThan(1e-5));
    }

    // From the joint's axes to those by which its axis and secondaryAxis are given.
    private static Vector3d Own(Vector3d v) => new(-v.Z, v.Y, v.X);

    // What the target does not move is locked.
    private World Make(
        bool swap = false,
        Vector3d position = default,
        Vector3d velocity = default,
        Quaterniond? rotation = null,
        JointDrive? linear = null,
        JointDrive? angular = null,
        RotationDriveMode mode = RotationDriveMode.XYAndZ,
        bool inWorld = false)
    {
        ConfigurableJointMotion slides = linear is null ? ConfigurableJointMotion.Locked : ConfigurableJointMotion.Free;
        ConfigurableJointMotion turns = angular is null ? ConfigurableJointMotion.Locked : ConfigurableJointMotion.Free;
        JointDrive none = new();
        return SmallScene.Create(
            new ConfigurableJoint
            {
                Axis = Vector3d.UnitZ,
                SecondaryAxis = Vector3d.UnitY,
                ConnectedBody = Other,
                SwapBodies = swap,
                ConfiguredInWorldSpace = inWorld,
                XMotion = slides,
                YMotion = slides,
                ZMotion = slides,
                AngularXMotion = turns,
                AngularYMotion = turns,
                AngularZMotion = turns,
                XDrive = linear ?? none,
                YDrive = linear ?? none,
                ZDrive = linear ?? none,
                RotationDriveMode = mode,
                AngularXDrive = angular ?? none,
                AngularYZDrive = angular ?? none,
                SlerpDrive = angular ?? none,
                TargetPosition = position,
                TargetVelocity = velocity,
                TargetRotation = rotation ?? Quaterniond.Identity,
            },
            connected: connected);
    }
}
