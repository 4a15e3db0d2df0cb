using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>Reads off a joint component what it leaves free.</summary>
internal static class JointFreedoms
{
    internal static IReadOnlyList<JointFreedom> Of(Joint joint, WorldTransform own, WorldTransform connected)
    {
        var freedoms = new List<JointFreedom>();
        switch (joint)
        {
            case HingeJoint hinge:
                freedoms.Add(hinge.UseLimits
                    ? new JointFreedom(Coordinate.Angle, hinge.Cut(hinge.Limits.Min), hinge.Cut(hinge.Limits.Max))
                    : Free(Coordinate.Angle));
                break;
            case ConfigurableJoint configurable:
                Linear(configurable, own, connected, freedoms);
                Angular(configurable, freedoms);
                break;
        }

        return freedoms;
    }

    /// <summary>Several limited axes share one radius; each is given its own range, reached while the others are at their middle.</summary>
    private static void Linear(ConfigurableJoint joint, WorldTransform own, WorldTransform connected, List<JointFreedom> freedoms)
    {
        Vector3d start = JointAnchors.StartGap(joint, own, connected);
        double limit = joint.LinearLimit.Limit;
        Add(Coordinate.X, joint.XMotion, -limit - start.X, limit - start.X, freedoms);
        Add(Coordinate.Y, joint.YMotion, -limit - start.Y, limit - start.Y, freedoms);
        Add(Coordinate.Z, joint.ZMotion, -limit - start.Z, limit - start.Z, freedoms);
    }

    /// <summary>The X limits are the connected body's: they turn over for the own one, unless the bodies are swapped.</summary>
    private static void Angular(ConfigurableJoint joint, List<JointFreedom> freedoms)
    {
        double low = joint.LowAngularXLimit.Limit, high = joint.HighAngularXLimit.Limit;
        Add(Coordinate.AngularX, joint.AngularXMotion, joint.SwapBodies ? low : -high, joint.SwapBodies ? high : -low, freedoms);
        Add(Coordinate.AngularY, joint.AngularYMotion, -joint.AngularYLimit.Limit, joint.AngularYLimit.Limit, freedoms);
        Add(Coordinate.AngularZ, joint.AngularZMotion, -joint.AngularZLimit.Limit, joint.AngularZLimit.Limit, freedoms);
    }

    private static void Add(Coordinate coordinate, ConfigurableJointMotion motion, double lower, double upper, List<JointFreedom> freedoms)
    {
        if (motion == ConfigurableJointMotion.Free)
            freedoms.Add(Free(coordinate));
        else if (motion == ConfigurableJointMotion.Limited)
            freedoms.Add(new JointFreedom(coordinate, lower, upper));
    }

    private static JointFreedom Free(Coordinate coordinate) => new(coordinate, double.NegativeInfinity, double.PositiveInfinity);
}
