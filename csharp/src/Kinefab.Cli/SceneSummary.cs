using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Validation;

namespace Kinefab.Cli;

/// <summary>What is in a scene, counted.</summary>
internal sealed class SceneSummary
{
    private readonly HashSet<int> _several;

    internal SceneSummary(ValidScene scene)
    {
        Document = scene.Document;
        for (int i = 0; i < Document.GameObjects.Count; i++)
        {
            IReadOnlyList<Component> components = Document.GameObjects[i].Components;
            Bodies += components.Count(component => component is Rigidbody or ArticulationBody);
            Colliders += components.Count(component => component is Collider);
            for (int c = 0; c < components.Count; c++)
            {
                if (components[c] is Joint || (components[c] is ArticulationBody && !scene.IsRootLink(i)))
                    Joints.Add(new JointSummary(i, c, components[c].GetType().Name, scene.Joint(new JointCoordinate { GameObject = i, Component = c }), scene.Freedoms(i, c)));
            }
        }

        _several = Joints.Where(joint => joint.Joint.Enabled).GroupBy(joint => joint.GameObject).Where(joints => joints.Skip(1).Any()).Select(joints => joints.Key).ToHashSet();
    }

    internal SceneDocument Document { get; }

    internal int Bodies { get; }

    internal int Colliders { get; }

    internal List<JointSummary> Joints { get; } = new();

    internal long Vertices => Document.Meshes.Sum(mesh => (long)mesh.VertexCount);

    internal long Triangles => Document.Meshes.Sum(mesh => mesh.Submeshes.Sum(submesh => (long)submesh.IndexCount)) / 3;

    /// <summary>Of a joint: its object's id, with [COMPONENT] behind it where the object carries several, or it is switched off.</summary>
    internal string NameOf(int gameObject, int component)
    {
        string id = Document.GameObjects[gameObject].Id;
        bool isOff = Document.GameObjects[gameObject].Components[component] is Joint { Enabled: false };
        return isOff || _several.Contains(gameObject) ? $"{id}[{component}]" : id;
    }

    internal int Count(Outcome outcome) => Document.Report.Count(entry => entry.Outcome == outcome);
}

/// <summary>A joint, where it stands and what it leaves free.</summary>
internal sealed record JointSummary(int GameObject, int Component, string Type, Joint Joint, IReadOnlyList<JointFreedom> Freedoms);
