using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Validation;

namespace Kinefab.Collisions;

/// <summary>
/// Which objects the source's rules keep from colliding. A rule names two bodies, or objects within bodies, and means these and all below them up to the
/// next body. Where one is asked about, nothing is climbed: a file may nest thousands of objects.
/// </summary>
internal sealed class IgnoredPairs
{
    // Trees of ranges where nothing and where everything is marked.
    private const int None = 0;
    private const int All = 1;

    // The top of what an object stands in: its body, or without one the topmost object.
    private readonly int[] _top;

    // Places of objects such that what stands below one, up to the next body, comes right after it, and how many that are with itself.
    private readonly int[] _place;
    private readonly int[] _size;

    // Most rules name bodies: of each pair of tops the lower one first.
    private readonly HashSet<(int, int)> _tops = new();

    // Of each object the tree of the places that it, or one above it, is kept from colliding with. Trees share what they have in common.
    private readonly int[] _marked;
    private readonly List<(int Left, int Right)> _halves = new() { (None, None), (All, All) };

    public IgnoredPairs(ValidScene scene)
    {
        IReadOnlyList<GameObject> objects = scene.Document.GameObjects;
        int count = scene.Document.IgnoredCollisions.Count > 0 ? objects.Count : 0;
        _top = new int[count];
        _place = new int[count];
        _size = new int[count];
        _marked = new int[count];
        Lay(scene, objects);
        var inner = new Dictionary<int, List<int>>();
        foreach (IgnoredCollision pair in scene.Document.IgnoredCollisions)
        {
            if (_top[pair.A] == pair.A && _top[pair.B] == pair.B)
                _tops.Add(Pair(pair.A, pair.B));
            else if (inner.TryGetValue(pair.A, out List<int>? others))
                others.Add(pair.B);
            else
                inner.Add(pair.A, new List<int> { pair.B });
        }

        for (int i = 0; i < count && inner.Count > 0; i++)
        {
            _marked[i] = _top[i] == i ? None : _marked[objects[i].Parent!.Value];
            if (inner.TryGetValue(i, out List<int>? others))
            {
                foreach (int other in others)
                    _marked[i] = Mark(_marked[i], 0, count, _place[other], _place[other] + _size[other]);
            }
        }
    }

    /// <summary>Whether a rule names the two, or what they stand below within their bodies.</summary>
    public bool Contains(int first, int second) =>
        _top.Length > 0 && (_tops.Contains(Pair(_top[first], _top[second])) || IsMarked(_marked[first], _place[second]) || IsMarked(_marked[second], _place[first]));

    /// <summary>The two, the lower one first.</summary>
    public static (int, int) Pair(int a, int b) => a < b ? (a, b) : (b, a);

    // Parents stand before their children.
    private void Lay(ValidScene scene, IReadOnlyList<GameObject> objects)
    {
        for (int i = 0; i < _top.Length; i++)
            _top[i] = scene.BodyOf(i) == i || objects[i].Parent is not int parent ? i : _top[parent];
        for (int i = _top.Length - 1; i >= 0; i--)
        {
            _size[i]++;
            if (_top[i] != i)
                _size[objects[i].Parent!.Value] += _size[i];
        }

        // Where the next object below one goes, and the next top.
        var free = new int[_top.Length];
        int next = 0;
        for (int i = 0; i < _top.Length; i++)
        {
            ref int at = ref next;
            if (_top[i] != i)
                at = ref free[objects[i].Parent!.Value];
            _place[i] = at;
            at += _size[i];
            free[i] = _place[i] + 1;
        }
    }

    // The tree of the places from low to high with those from one to another marked too.
    private int Mark(int tree, int low, int high, int from, int end)
    {
        if (tree == All || end <= low || high <= from)
            return tree;
        if (from <= low && high <= end)
            return All;
        int middle = (low + high) / 2;
        (int left, int right) = _halves[tree];
        _halves.Add((Mark(left, low, middle, from, end), Mark(right, middle, high, from, end)));
        return _halves.Count - 1;
    }

    private bool IsMarked(int tree, int place)
    {
        (int low, int high) = (0, _top.Length);
        while (tree > All)
        {
            int middle = (low + high) / 2;
            bool isLeft = place < middle;
            tree = isLeft ? _halves[tree].Left : _halves[tree].Right;
            (low, high) = isLeft ? (low, middle) : (middle, high);
        }

        return tree == All;
    }
}
