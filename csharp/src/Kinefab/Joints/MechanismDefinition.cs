using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Joints;

/// <summary>Bodies and joints of a scene as Unity makes them when it starts.</summary>
internal sealed class MechanismDefinition
{
    private MechanismDefinition(int[] gameObjects, int[] bodyOf, List<JointDefinition> joints)
    {
        GameObjects = gameObjects;
        BodyOf = bodyOf;
        Joints = joints;
    }

    /// <summary>For each body the GameObject that carries its Rigidbody.</summary>
    public int[] GameObjects { get; }

    /// <summary>For each GameObject the body that moves it, or Joint.World.</summary>
    public int[] BodyOf { get; }

    public IReadOnlyList<JointDefinition> Joints { get; }

    public static MechanismDefinition From(ValidScene scene)
    {
        IReadOnlyList<GameObject> objects = scene.Document.GameObjects;
        var bodies = new List<int>();
        var bodyOf = new int[objects.Count];
        for (int i = 0; i < objects.Count; i++)
        {
            if (scene.Body(i) is null)
            {
                bodyOf[i] = objects[i].Parent is int parent ? bodyOf[parent] : Joint.World;
            }
            else
            {
                bodyOf[i] = bodies.Count;
                bodies.Add(i);
            }
        }

        var joints = new List<JointDefinition>();
        for (int i = 0; i < objects.Count; i++)
        {
            for (int c = 0; c < objects[i].Components.Count; c++)
            {
                if (objects[i].Components[c] is Document.Joint joint)
                {
                    joints.Add(new JointDefinition(i, c, joint, Make(scene, i, joint, bodyOf)));
                }
            }
        }

        return new MechanismDefinition(bodies.ToArray(), bodyOf, joints);
    }

    private static Joint Make(ValidScene scene, int own, Document.Joint source, int[] bodyOf)
    {
        WorldTransform a = scene.World(own);
        WorldTransform b = source.ConnectedBody is int other ? scene.World(other) : new WorldTransform(Pose.Identity, new Vector3d(1, 1, 1));
        Vector3d anchor = Vector3d.Zero;
        Quaterniond frame = Quaterniond.Identity;
        Vector3d connected = a.Pose.Position;
        bool worldSpace = source is ConfigurableJoint { ConfiguredInWorldSpace: true };
        if (source is AnchoredJoint anchored)
        {
            anchor = Vector3d.Scale(anchored.Anchor, a.Scale);
            Vector3d secondary = source is ConfigurableJoint c ? c.SecondaryAxis : Vector3d.Zero;
            frame = Orientation(anchored.Axis, secondary);
            connected = anchored.AutoConfigureConnectedAnchor
                ? a.Pose.Point(anchor)
                : b.Pose.Point(Vector3d.Scale(anchored.ConnectedAnchor, b.Scale));
        }

        Quaterniond world = worldSpace ? frame : a.Pose.Rotation * frame;
        var ownFrame = new Pose(anchor, a.Pose.Rotation.Conjugate() * world);
        var connectedFrame = new Pose(b.Pose.InversePoint(connected), b.Pose.Rotation.Conjugate() * world);
        Joint joint = Axes(source);
        bool swap = source is ConfigurableJoint { SwapBodies: true };
        int ownBody = bodyOf[own];
        int connectedBody = source.ConnectedBody is int index ? bodyOf[index] : Joint.World;
        joint.Body0 = swap ? connectedBody : ownBody;
        joint.Body1 = swap ? ownBody : connectedBody;
        joint.Frame0 = swap ? connectedFrame : ownFrame;
        joint.Frame1 = swap ? ownFrame : connectedFrame;
        return joint;
    }

    private static Joint Axes(Document.Joint source)
    {
        const double radians = Math.PI / 180;
        switch (source)
        {
            case HingeJoint hinge:
                return new RevoluteJoint
                {
                    LimitEnabled = hinge.UseLimits,
                    ExtendedLimits = hinge.ExtendedLimits,
                    Limit = new AngularLimit { Lower = -hinge.Limits.Max * radians, Upper = -hinge.Limits.Min * radians },
                };
            case ConfigurableJoint c:
                return new D6Joint
                {
                    X = (AxisMotion)c.XMotion,
                    Y = (AxisMotion)c.YMotion,
                    Z = (AxisMotion)c.ZMotion,
                    Twist = (AxisMotion)c.AngularXMotion,
                    Swing1 = (AxisMotion)c.AngularYMotion,
                    Swing2 = (AxisMotion)c.AngularZMotion,
                    LinearLimit = new LinearLimit { Value = c.LinearLimit.Limit },
                    TwistLimit = new AngularLimit { Lower = c.LowAngularXLimit.Limit * radians, Upper = c.HighAngularXLimit.Limit * radians },
                    SwingLimit = new ConeLimit { Y = c.AngularYLimit.Limit * radians, Z = c.AngularZLimit.Limit * radians },
                };
            default:
                return new D6Joint();
        }
    }

    // x = axis, y = the part of secondary at right angles to it, z = x cross y; Unity's stand-ins for degenerate input.
    private static Quaterniond Orientation(Vector3d axis, Vector3d secondary)
    {
        Vector3d x = axis.Length > 0 ? axis.Normalized() : Vector3d.UnitX;
        Vector3d y = secondary - x * Vector3d.Dot(x, secondary);
        y = y.Length > 1e-6 * Math.Max(secondary.Length, 1e-30) ? y.Normalized() : Vector3d.Perpendicular(x);
        return Quaterniond.FromAxes(x, y, Vector3d.Cross(x, y));
    }
}

/// <summary>A joint and the component it was made from.</summary>
internal readonly struct JointDefinition
{
    public readonly int GameObject;
    public readonly int Component;
    public readonly Document.Joint Source;
    public readonly Joint Joint;

    public JointDefinition(int gameObject, int component, Document.Joint source, Joint joint)
    {
        GameObject = gameObject;
        Component = component;
        Source = source;
        Joint = joint;
    }
}
