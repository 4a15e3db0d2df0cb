using System;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>Where each GameObject stands in the world, which body moves it and whether it is active, worked out in the file's order: parents stand before their children.</summary>
internal sealed class HierarchyPlaces
{
    private const int Nobody = -1;

    private readonly WorldTransform[] world;
    private readonly int[] bodyOf;
    private readonly int[] linkOf;
    private readonly int[] linkAbove;
    private readonly bool[] isActive;
    private int count;

    /// <summary>Before the first of so many GameObjects.</summary>
    internal HierarchyPlaces(int gameObjects)
    {
        world = new WorldTransform[gameObjects];
        bodyOf = new int[gameObjects];
        linkOf = new int[gameObjects];
        linkAbove = new int[gameObjects];
        isActive = new bool[gameObjects];
    }

    /// <summary>How many GameObjects have their places by now.</summary>
    internal int Count => count;

    /// <summary>Of all GameObjects.</summary>
    internal static HierarchyPlaces Of(SceneDocument document)
    {
        ReadOnlySpan<GameObject> objects = document.GameObjectSpan;
        var places = new HierarchyPlaces(objects.Length);
        foreach (GameObject gameObject in objects)
            places.Add(gameObject);
        return places;
    }

    /// <summary>The next GameObject; one whose parent does not stand before it, which no valid scene has, is placed as a root.</summary>
    internal void Add(GameObject gameObject)
    {
        Transform local = gameObject.Transform;
        var pose = new Pose(local.LocalPosition, local.LocalRotation.Normalized());
        int parent = gameObject.Parent is int above && (uint)above < (uint)count ? above : Nobody;
        world[count] = parent == Nobody ? new WorldTransform(pose, local.LocalScale) : world[parent].Child(pose, local.LocalScale);
        bodyOf[count] = gameObject.Body is not null ? count : parent == Nobody ? Nobody : bodyOf[parent];
        linkAbove[count] = parent == Nobody ? Nobody : linkOf[parent];
        linkOf[count] = gameObject.Link is not null ? count : linkAbove[count];
        isActive[count] = gameObject.Active && (parent == Nobody || isActive[parent]);
        count++;
    }

    /// <summary>Of a GameObject that was added.</summary>
    internal ref readonly WorldTransform World(int gameObject) => ref world[gameObject];

    /// <summary>Whether it and all above it are: GameObject.activeInHierarchy.</summary>
    internal bool IsActive(int gameObject) => isActive[gameObject];

    /// <summary>The GameObject whose Rigidbody moves this one: itself or its nearest ancestor that has one; null: nothing does.</summary>
    internal int? BodyOf(int gameObject) => bodyOf[gameObject] is var body && body != Nobody ? body : null;

    /// <summary>The GameObject of the link above one: its nearest ancestor with an ArticulationBody; null: there is none.</summary>
    internal int? LinkAbove(int gameObject) => linkAbove[gameObject] is var link && link != Nobody ? link : null;
}
