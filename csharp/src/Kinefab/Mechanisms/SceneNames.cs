using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Joints;

namespace Kinefab.Mechanisms;

/// <summary>
/// What the joints of a scene are called, and who answers to a name. A joint is called by the id of its GameObject, with
/// [COMPONENT] behind it where the object carries several: Lever/Crank:1, Arm:2[3].
/// </summary>
internal sealed class SceneNames
{
    // A message is for reading.
    private const int MostListed = 40;

    private readonly IReadOnlyList<GameObject> _objects;
    private readonly Dictionary<string, int> _objectsById = new(StringComparer.Ordinal);
    private readonly HashSet<int> _several = new();

    /// <summary>Names for the joints at these places; a place may stand there more than once.</summary>
    public SceneNames(IReadOnlyList<GameObject> objects, IEnumerable<(int GameObject, int Component)> joints)
    {
        _objects = objects;
        for (int i = 0; i < objects.Count; i++)
        {
            _objectsById.TryAdd(objects[i].Id, i);
        }

        var components = new Dictionary<int, int>();
        foreach ((int gameObject, int component) in joints)
        {
            if (!components.TryAdd(gameObject, component) && components[gameObject] != component)
            {
                _several.Add(gameObject);
            }
        }
    }

    /// <summary>What a joint is called.</summary>
    public string Joint(int gameObject, int component) =>
        _several.Contains(gameObject) ? $"{_objects[gameObject].Id}[{component}]" : _objects[gameObject].Id;

    /// <summary>By id, else by a name that no other object has; -1: none.</summary>
    public int GameObject(string name) => _objectsById.TryGetValue(name, out int index) ? index : Named(name);

    /// <summary>Of some things of joints those whose joint answers to a name: by the object's id or, if none does, by its name, [COMPONENT] behind it or not.</summary>
    public List<T> Called<T>(string name, IReadOnlyList<T> among, Func<T, (int GameObject, int Component)> place)
    {
        List<T> byId = among.Where(one => Answers(_objects[place(one).GameObject].Id, one)).ToList();
        return byId.Count > 0 ? byId : among.Where(one => Answers(_objects[place(one).GameObject].Name, one)).ToList();

        bool Answers(string called, T one) =>
            called == name || (name.Length > called.Length && name.StartsWith(called, StringComparison.Ordinal) && name == $"{called}[{place(one).Component}]");
    }

    /// <summary>Names for a message: "there are a, b, c".</summary>
    public static string List(IReadOnlyCollection<string> names) =>
        string.Join(", ", names.Take(MostListed)) + (names.Count > MostListed ? $" and {names.Count - MostListed} more" : "");

    // Apart, so that finding an id allocates no closure.
    private int Named(string name)
    {
        int[] named = Enumerable.Range(0, _objects.Count).Where(i => _objects[i].Name == name).ToArray();
        return named.Length == 1 ? named[0] : -1;
    }
}
