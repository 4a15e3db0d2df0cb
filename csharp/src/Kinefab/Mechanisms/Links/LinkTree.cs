using System;
using System.Collections.Generic;
using Kinefab.Diagnostics;
using Kinefab.Document;

namespace Kinefab.Mechanisms;

/// <summary>A joint by its object and its place among the object's components.</summary>
internal readonly record struct JointPlace(int GameObject, int Component)
{
    /// <summary>In the file.</summary>
    internal string Pointer => FormattableString.Invariant($"/gameObjects/{GameObject}/components/{Component}");
}

/// <summary>A link, the one above it and the joint between them; of a root neither.</summary>
internal readonly record struct Branch(int Child, int? Parent, JointPlace? Joint);

/// <summary>
/// Which joints of a scene become links and which stay: from the ground outwards, then from what else stands or scripts move, by joints that close no loop as the
/// file says it; the rest of what is reached closes one.
/// </summary>
internal sealed class LinkTree
{
    private const string GroundId = "kinefab:ground";

    // Of the root that stands for the world where no object does.
    private const string ArticulationGroundId = "kinefab:articulation ground";

    private readonly List<GameObject> objects;
    private readonly List<JointPlace> joints = new();
    private readonly int ground;

    internal LinkTree(SceneDocument document, List<Diagnostic> findings)
    {
        objects = new List<GameObject>(document.GameObjects);
        bool needsGround = false;
        for (int i = 0; i < objects.Count; i++)
        {
            if (objects[i].Body is Rigidbody body)
                Bodies[i] = body;
            for (int c = 0; c < objects[i].Components.Count; c++)
            {
                if (objects[i].Components[c] is not Joint joint)
                    continue;
                if (IsLeftOut(joint))
                {
                    findings.Add(LinkLosses.Dropped(joint, objects[i].Id, new JointPlace(i, c).Pointer));
                }
                else if (objects[i].Body is not null)
                {
                    joints.Add(new JointPlace(i, c));
                    needsGround |= joint.ConnectedBody is null;
                }
            }
        }

        ground = objects.FindIndex(each => each.Id == GroundId && each.Body is not null);
        if (ground < 0 && needsGround)
        {
            ground = objects.Count;
            objects.Add(new GameObject { Id = ArticulationGroundId, Name = "Ground" });
            Bodies[ground] = new Rigidbody { IsKinematic = true, UseGravity = false };
        }

        Grow();
        var inner = new HashSet<JointPlace>();
        foreach (Branch branch in Branches)
        {
            if (branch.Joint is JointPlace place)
                inner.Add(place);
        }

        Closing = joints.FindAll(place => !inner.Contains(place));
    }

    /// <summary>Of the scene, and last the one that stands for the world where none did.</summary>
    internal IReadOnlyList<GameObject> Objects => objects;

    /// <summary>By the index of their object.</summary>
    internal Dictionary<int, Rigidbody> Bodies { get; } = new();

    /// <summary>Roots first.</summary>
    internal List<Branch> Branches { get; } = new();

    /// <summary>In the order of the file.</summary>
    internal IReadOnlyList<JointPlace> Closing { get; }

    internal Joint Joint(JointPlace place) => (Joint)objects[place.GameObject].Components[place.Component];

    /// <summary>The object at the other end of a joint.</summary>
    internal int Other(JointPlace place) => Joint(place).ConnectedBody ?? ground;

    /// <summary>The source's id of a joint, else the id of its object.</summary>
    internal string NameOf(JointPlace place) => Joint(place).Id is { Length: > 0 } id ? id : objects[place.GameObject].Id;

    // Joints that only keep bodies from colliding would hold helper bodies apart, not the links; those that are switched off no joint of Unity's can be.
    private static bool IsLeftOut(Joint joint) => !joint.Enabled || JointExtras.KeepsApart(joint);

    private void Grow()
    {
        var at = new Dictionary<int, List<JointPlace>>();
        foreach (bool closes in new[] { false, true })
        {
            foreach (JointPlace place in joints)
            {
                if (Joint(place).Closure != closes)
                    continue;
                Beside(at, place.GameObject).Add(place);
                Beside(at, Other(place)).Add(place);
            }
        }

        var roots = new List<int>();
        if (ground >= 0)
            roots.Add(ground);
        var indices = new List<int>(Bodies.Keys);
        indices.Sort();
        roots.AddRange(indices.FindAll(i => Bodies[i].IsKinematic));
        roots.AddRange(indices.FindAll(i => !Bodies[i].IsKinematic));
        var found = new HashSet<int>();
        foreach (int root in roots)
        {
            if (!at.ContainsKey(root) || !found.Add(root))
                continue;
            Branches.Add(new Branch(root, null, null));
            var waiting = new Queue<int>();
            waiting.Enqueue(root);
            while (waiting.Count > 0)
            {
                int body = waiting.Dequeue();
                foreach (JointPlace place in at[body])
                {
                    int other = place.GameObject != body ? place.GameObject : Other(place);
                    if (Bodies[other].IsKinematic || !found.Add(other))
                        continue;
                    Branches.Add(new Branch(other, body, place));
                    waiting.Enqueue(other);
                }
            }
        }
    }

    private static List<JointPlace> Beside(Dictionary<int, List<JointPlace>> at, int body)
    {
        if (!at.TryGetValue(body, out List<JointPlace>? list))
            at[body] = list = new List<JointPlace>();
        return list;
    }
}
