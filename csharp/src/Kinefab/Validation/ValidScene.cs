using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>A scene without errors: every reference resolves, every number is one that Unity takes.  Only <c>SceneValidator</c> makes one.</summary>
public sealed partial class ValidScene
{
    private readonly WorldTransform[] world;

    internal ValidScene(SceneDocument document)
    {
        Document = document;
        world = Validation.WorldTransform.Of(document);
    }

    /// <summary>The scene.</summary>
    public SceneDocument Document { get; }

    /// <summary>Pose and scale of a GameObject in the world, as exported.</summary>
    public WorldTransform WorldTransform(int gameObject) => world[gameObject];

    /// <summary>The numbers of a mesh.</summary>
    public MeshData Mesh(int mesh) => new(Document, Document.Meshes[mesh]);

    /// <summary>What a joint leaves to its own body.</summary>
    /// <param name="gameObject">Index of the GameObject that carries the joint.</param>
    /// <param name="component">Index of the joint in its components.</param>
    public IReadOnlyList<JointFreedom> Freedoms(int gameObject, int component)
    {
        var joint = (Joint)Document.GameObjects[gameObject].Components[component];
        return JointFreedoms.Of(joint, WorldTransform(gameObject), Connected(joint));
    }

    /// <summary>Where the connected body of a joint stands; the world's own place when there is none.</summary>
    internal WorldTransform Connected(Joint joint) =>
        joint.ConnectedBody is int body ? WorldTransform(body) : new WorldTransform(Pose.Identity, new Vector3d(1, 1, 1));

    /// <summary>The Rigidbody of a GameObject; null when it has none.</summary>
    public Rigidbody? Body(int gameObject) => Document.GameObjects[gameObject].Body;

    /// <summary>The GameObject whose Rigidbody moves this one: itself or its nearest ancestor that has one; null: nothing does.</summary>
    public int? BodyOf(int gameObject)
    {
        int? at = gameObject;
        while (at is int index && Body(index) is null)
            at = Document.GameObjects[index].Parent;
        return at;
    }

    /// <summary>The joint that a coupling refers to.</summary>
    public Joint Joint(JointCoordinate coordinate)
    {
        if (coordinate is null)
            throw new ArgumentNullException(nameof(coordinate));
        return (Joint)Document.GameObjects[coordinate.GameObject].Components[coordinate.Component];
    }
}
