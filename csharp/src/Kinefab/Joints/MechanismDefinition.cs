using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Joints;

/// <summary>Bodies and joints of a scene as Unity makes them when it starts; a body's frame is its GameObject's, unscaled.</summary>
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

    /// <summary>In order of GameObject and component.</summary>
    public IReadOnlyList<JointDefinition> Joints { get; }

    /// <summary>What Unity makes of a scene: inactive objects have neither bodies nor joints.</summary>
    public static MechanismDefinition From(ValidScene scene)
    {
        IReadOnlyList<GameObject> objects = scene.Document.GameObjects;
        var bodies = new List<int>();
        var bodyOf = new int[objects.Count];
        var isActive = new bool[objects.Count];
        for (int i = 0; i < objects.Count; i++)
        {
            isActive[i] = objects[i].Active && (objects[i].Parent is not int above || isActive[above]);
            bodyOf[i] = objects[i].Parent is int parent ? bodyOf[parent] : Joint.World;
            if (isActive[i] && scene.Body(i) is not null)
            {
                bodyOf[i] = bodies.Count;
                bodies.Add(i);
            }
        }

        var joints = new List<JointDefinition>();
        for (int i = 0; i < objects.Count; i++)
        {
            for (int c = 0; isActive[i] && c < objects[i].Components.Count; c++)
            {
                if (objects[i].Components[c] is Document.Joint joint)
                {
                    joints.Add(new JointDefinition(i, c, joint, Make(scene, i, joint, bodies, bodyOf)));
                }
            }
        }

        return new MechanismDefinition(bodies.ToArray(), bodyOf, joints);
    }

    // An inactive connected body has left the simulation: the joint holds to the world where it stands.
    private static Joint Make(ValidScene scene, int own, Document.Joint settings, List<int> bodies, int[] bodyOf)
    {
        int other = settings.ConnectedBody is int body ? bodyOf[body] : Joint.World;
        return SceneJoint.Make(scene, own, settings, bodyOf[own], Start(bodyOf[own]), other, Start(other));

        Pose Start(int place) => place < 0 ? Pose.Identity : scene.WorldTransform(bodies[place]).Pose;
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
