using System;
using System.Collections.Generic;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Bench.Peers;

/// <summary>A joint of a scene as every engine has it: a hinge about X of a frame in which both bodies stand together now.</summary>
/// <param name="Body0">-1 for the world.</param>
/// <param name="Body1">-1 for the world.</param>
/// <param name="Frame">World frame.</param>
/// <param name="Frame0">The same frame in body 0.</param>
/// <param name="Frame1">The same frame in body 1.</param>
/// <param name="IsDriven">Whether a motor holds its angle.</param>
internal readonly record struct PeerHinge(int Body0, int Body1, Pose Frame, Pose Frame0, Pose Frame1, bool IsDriven)
{
    /// <summary>A scene's joints.</summary>
    /// <exception cref="NotSupportedException">One of them is no hinge.</exception>
    public static IEnumerable<PeerHinge> Of(MultibodySystem scene)
    {
        foreach (JointModel joint in scene.Joints)
        {
            bool isDriven = joint is D6Joint { Twist: AxisMotion.Free, DriveTwist.Stiffness: > 0 };
            if (!isDriven && joint is not RevoluteJoint)
                throw new NotSupportedException("Peers run hinges only.");
            yield return new PeerHinge(joint.Body0, joint.Body1, scene.Bodies.PoseOf(joint.Body1) * joint.Frame1, joint.Frame0, joint.Frame1, isDriven);
        }
    }
}
