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

    // Of the objects that the source's rules name.
    private readonly HashSet<(int, int)> _ignored = new();

    public CollisionPairs(ValidScene scene)
    {
        _scene = scene;
        IReadOnlyList<GameObject> objects = scene.Document.GameObjects;
        for (int i = 0; i < objects.Count; i++)
        {
            foreach (Component component in objects[i].Components)
            {
                if (component is Joint { Enabled: true, ConnectedBody: int connected, EnableCollision: false })
                    _joined.Add(Pair(Body(i), Body(connected)));
            }

            // PhysX lets no link touch the one above it.
            if (scene.Held(i) is { ConnectedBody: int parent })
                _joined.Add(Pair(i, parent));
        }

        foreach (IgnoredCollision pair in scene.Document.IgnoredCollisions)
            _ignored.Add(Pair(pair.A, pair.B));
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

    /// <summary>Whether colliders of two objects push each other where they meet.</summary>
    public bool MayCollide(int first, int second)
    {
        (int a, int b) = (Body(first), Body(second));
        return a != b && (Moves(a) || Moves(b)) && !_joined.Contains(Pair(a, b)) && !AreIgnored(first, second);
    }

    private bool Moves(int body) => body != Nobody && _scene.Body(body) is { IsKinematic: false };

    private int Body(int gameObject) => _scene.BodyOf(gameObject) ?? Nobody;

    // A rule may name a body, or an object within it.
    private bool AreIgnored(int first, int second)
    {
        if (_ignored.Count == 0)
            return false;
        for (int? a = first; a is int one; a = Above(one))
        {
            for (int? b = second; b is int other; b = Above(other))
            {
                if (_ignored.Contains(Pair(one, other)))
                    return true;
            }
        }

        return false;
    }

    private int? Above(int gameObject) => Body(gameObject) == gameObject ? null : _scene.Document.GameObjects[gameObject].Parent;

    private static (int, int) Pair(int a, int b) => a < b ? (a, b) : (b, a);
}
