using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Validation;

namespace Kinefab.Collisions;

/// <summary>Which objects' colliders may push each other: those of two bodies, or of a body and what has none, that nothing tells apart.</summary>
internal sealed class CollisionPairs
{
    private const int Nobody = -1;

    private readonly ValidScene _scene;

    // Of two bodies that a joint keeps from colliding, the lower object first.
    private readonly HashSet<(int, int)> _joined = new();

    private readonly IgnoredPairs _ignored;

    public CollisionPairs(ValidScene scene)
    {
        _scene = scene;
        IReadOnlyList<GameObject> objects = scene.Document.GameObjects;
        for (int i = 0; i < objects.Count; i++)
        {
            foreach (Component component in objects[i].Components)
            {
                if (component is Joint { Enabled: true, ConnectedBody: int connected, EnableCollision: false })
                    _joined.Add(IgnoredPairs.Pair(Body(i), Body(connected)));
            }

            // PhysX lets no link touch the one above it.
            if (scene.Held(i) is { ConnectedBody: int parent })
                _joined.Add(IgnoredPairs.Pair(i, parent));
        }

        _ignored = new IgnoredPairs(scene);
    }

    /// <summary>Whether some body moves by forces at all.</summary>
    public bool HasMoving
    {
        get
        {
            for (int i = 0; i < _scene.Document.GameObjects.Count; i++)
            {
                if (Moves(i))
                    return true;
            }

            return false;
        }
    }

    /// <summary>A number for what never collides among itself: one body's objects, and all that no force moves.</summary>
    public int Group(int gameObject)
    {
        int body = Body(gameObject);
        return Moves(body) ? body : Nobody;
    }

    /// <summary>Whether colliders of two objects push each other where they meet.</summary>
    public bool MayCollide(int first, int second)
    {
        (int a, int b) = (Body(first), Body(second));
        return a != b && (Moves(a) || Moves(b)) && !_joined.Contains(IgnoredPairs.Pair(a, b)) && !_ignored.Contains(first, second);
    }

    private bool Moves(int body) => body != Nobody && _scene.Body(body) is { IsKinematic: false };

    private int Body(int gameObject) => _scene.BodyOf(gameObject) ?? Nobody;
}
