using System;
using System.Collections.Generic;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Bench.Peers;

/// <summary>A joint of a scene as every engine has it: a hinge about, or a slider along, X of a frame in which both bodies stand together now.</summary>
/// <param name="Body0">-1 for the world.</param>
/// <param name="Body1">-1 for the world.</param>
/// <param name="Frame">World frame.</param>
/// <param name="Frame0">The same frame in body 0.</param>
/// <param name="Frame1">The same frame in body 1.</param>
/// <param name="IsSlider">Whether it is no hinge.</param>
/// <param name="Motor">Of a hinge: the speed of body 1 against body 0 that a motor holds, rad/s, and its largest torque, N m; null without one.</param>
internal readonly record struct PeerJoint(int Body0, int Body1, Pose Frame, Pose Frame0, Pose Frame1, bool IsSlider, (double Speed, double Limit)? Motor)
{
    private const double StrongMotor = 1e6;

    /// <summary>A scene's joints.</summary>
    /// <exception cref="NotSupportedException">One of them is neither hinge nor slider.</exception>
    public static IEnumerable<PeerJoint> Of(MultibodySystem scene)
    {
        foreach (JointModel joint in scene.Joints)
        {
            (bool isSlider, (double, double)? motor) = joint switch
            {
                RevoluteJoint { MotorEnabled: true } hinge => (false, (hinge.MotorVelocity, hinge.MotorForceLimit)),
                RevoluteJoint => (false, null),
                D6Joint { Twist: AxisMotion.Free, DriveTwist.Stiffness: > 0 } => (false, (0, StrongMotor)),
                D6Joint { X: AxisMotion.Free, Y: AxisMotion.Locked, Z: AxisMotion.Locked, Twist: AxisMotion.Locked, Swing1: AxisMotion.Locked, Swing2: AxisMotion.Locked } =>
                    (true, default((double, double)?)),
                _ => throw new NotSupportedException("Peers run hinges and sliders only."),
            };
            yield return new PeerJoint(joint.Body0, joint.Body1, scene.Bodies.PoseOf(joint.Body1) * joint.Frame1, joint.Frame0, joint.Frame1, isSlider, motor);
        }
    }

    /// <summary>A scene's joints for an engine whose peer has hinges that are free or held.</summary>
    /// <exception cref="NotSupportedException">One of them is another.</exception>
    public static IEnumerable<PeerJoint> Hinges(MultibodySystem scene)
    {
        foreach (PeerJoint joint in Of(scene))
            yield return joint.IsSlider || joint.Motor is { Speed: not 0 } ? throw new NotSupportedException("This peer runs hinges only.") : joint;
    }
}
