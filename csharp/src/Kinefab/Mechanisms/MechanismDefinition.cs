using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Joints;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Mechanisms;

/// <summary>
/// Which bodies and joints Unity makes of a scene when it starts. Kinematics and dynamics are both built from this one walk
/// over the scene, so that they can differ in no body and in no joint's ends.
/// </summary>
internal sealed class MechanismDefinition
{
    // For each GameObject the index of its first joint; one more: their number.
    private readonly int[] _firstJoints;

    private MechanismDefinition(int[] gameObjects, int[] bodyOf, JointDefinition[] joints, int[] firstJoints)
    {
        GameObjects = gameObjects;
        BodyOf = bodyOf;
        Joints = joints;
        _firstJoints = firstJoints;
    }

    /// <summary>For each body the GameObject that carries its Rigidbody.</summary>
    public int[] GameObjects { get; }

    /// <summary>For each GameObject the body that carries it along, or Joint.World.</summary>
    public int[] BodyOf { get; }

    /// <summary>In order of GameObject and component; a link's own joint among them.</summary>
    public IReadOnlyList<JointDefinition> Joints { get; }

    /// <summary>What Unity makes of a scene: inactive objects have neither bodies nor joints, and joints that are switched off are none.</summary>
    public static MechanismDefinition From(ValidScene scene)
    {
        IReadOnlyList<GameObject> objects = scene.Document.GameObjects;
        var bodies = new List<int>();
        var bodyOf = new int[objects.Count];
        for (int i = 0; i < objects.Count; i++)
        {
            bodyOf[i] = objects[i].Parent is int parent ? bodyOf[parent] : Kinefab.Joints.JointModel.World;
            if (scene.IsActive(i) && scene.Body(i) is not null)
            {
                bodyOf[i] = bodies.Count;
                bodies.Add(i);
            }
        }

        var joints = new List<JointDefinition>();
        var firstJoints = new int[objects.Count + 1];
        for (int i = 0; i < objects.Count; i++)
        {
            for (int c = 0; scene.IsActive(i) && c < objects[i].Components.Count; c++)
            {
                if (objects[i].Components[c] is Document.Joint { Enabled: true } joint)
                {
                    joints.Add(new JointDefinition(i, c, joint, bodyOf[i], Connected(joint)));
                }
                else if (objects[i].Components[c] is ArticulationBody link && scene.Held(i) is Document.Joint held)
                {
                    joints.Add(new JointDefinition(i, c, held, bodyOf[i], Connected(held), link));
                }
            }

            firstJoints[i + 1] = joints.Count;
        }

        return new MechanismDefinition(bodies.ToArray(), bodyOf, joints.ToArray(), firstJoints);

        // An inactive connected body has left the simulation: the joint holds to the world where it stands, also where a body
        // further up would carry that object along. The connected object has a Rigidbody of its own, or the scene is not valid.
        int Connected(Document.Joint joint) => joint.ConnectedBody is int other && scene.IsActive(other) ? bodyOf[other] : Kinefab.Joints.JointModel.World;
    }

    /// <summary>The joints, with frames in the bodies' frames.</summary>
    /// <param name="scene">The one that this was made from.</param>
    /// <param name="starts">For each body its frame in the world at start-up.</param>
    public Kinefab.Joints.JointModel[] MakeJoints(ValidScene scene, Pose[] starts)
    {
        var joints = new Kinefab.Joints.JointModel[Joints.Count];
        for (int j = 0; j < joints.Length; j++)
        {
            joints[j] = SceneJoint.Make(scene, Joints[j], starts);
        }

        return joints;
    }

    /// <summary>Index of a component's joint in <see cref="Joints"/>; -1 when its object is inactive or it is switched off.</summary>
    public int IndexOf(int gameObject, int component)
    {
        // By halves: couplings may name each of thousands of joints of one object.
        int low = _firstJoints[gameObject];
        int end = _firstJoints[gameObject + 1];
        while (low < end)
        {
            int middle = (low + end) / 2;
            if (Joints[middle].Component < component)
            {
                low = middle + 1;
            }
            else
            {
                end = middle;
            }
        }

        return low < _firstJoints[gameObject + 1] && Joints[low].Component == component ? low : -1;
    }
}
