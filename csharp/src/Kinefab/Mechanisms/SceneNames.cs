using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;

namespace Kinefab.Mechanisms;

/// <summary>
/// What the joints of a scene are called, and who answers to a name. A joint is called by the id of its GameObject, with
/// [COMPONENT] behind it where the object carries several: Lever/Crank:1, Arm:2[3]. It answers to the CAD's own names first:
/// the user's for the joint, then those of the constraints that it stands for; then to the object's id, then to its name.
/// </summary>
internal sealed class SceneNames
{
    // A message is for reading.
    private const int MostListed = 40;

    private readonly IReadOnlyList<GameObject> _objects;
    private readonly Dictionary<string, int> _objectsById = new(StringComparer.Ordinal);
    private readonly HashSet<int> _several = new();

    // What the source calls a joint, and what it calls the constraints that a joint stands for.
    private readonly Dictionary<string, HashSet<(int GameObject, int Component)>> _named = new(StringComparer.Ordinal);
    private readonly Dictionary<string, HashSet<(int GameObject, int Component)>> _sources = new(StringComparer.Ordinal);
    private readonly Dictionary<(int GameObject, int Component), string> _cadNames = new();

    /// <summary>Names for the joints at these places; a place may stand there more than once.</summary>
    public SceneNames(IReadOnlyList<GameObject> objects, IEnumerable<(int GameObject, int Component)> joints)
    {
        _objects = objects;
        for (int i = 0; i < objects.Count; i++)
        {
            _objectsById.TryAdd(objects[i].Id, i);
        }

        var components = new Dictionary<int, int>();
        foreach ((int GameObject, int Component) place in joints.Distinct())
        {
            if (!components.TryAdd(place.GameObject, place.Component))
            {
                _several.Add(place.GameObject);
            }

            AddCadNames(place);
        }
    }

    /// <summary>What a joint is called; also with [COMPONENT] where the source calls another joint by the object's id.</summary>
    public string Joint(int gameObject, int component)
    {
        string id = _objects[gameObject].Id;
        return _several.Contains(gameObject) || IsTaken(_named, id, gameObject) || IsTaken(_sources, id, gameObject) ? $"{id}[{component}]" : id;
    }

    /// <summary>The user's own name for a joint in the source; null: not known.</summary>
    public string? NameInCad(int gameObject, int component) => _cadNames.TryGetValue((gameObject, component), out string? name) ? name : null;

    /// <summary>Whether the source calls a joint so, or a constraint that a joint stands for.</summary>
    public bool IsNameInCad(string name) => _named.ContainsKey(name) || _sources.ContainsKey(name);

    /// <summary>What goes behind a joint's name in a message: "Shaft" in quotes, after a space; empty where it is not known.</summary>
    public string InWords(int gameObject, int component) => NameInCad(gameObject, component) is string name ? $" \"{name}\"" : "";

    /// <summary>By id, else by a name that no other object has; -1: none, or several.</summary>
    /// <param name="name">An id or a name.</param>
    /// <param name="several">Ids of those that have the name; empty unless there are several.</param>
    public int GameObject(string name, out IReadOnlyList<string> several)
    {
        several = Array.Empty<string>();
        return _objectsById.TryGetValue(name, out int index) ? index : Named(name, ref several);
    }

    /// <summary>Of some things of joints those whose joint answers to a name.</summary>
    public List<T> Called<T>(string name, IReadOnlyList<T> among, Func<T, (int GameObject, int Component)> place)
    {
        List<T> found = Cad(_named);
        if (found.Count == 0)
            found = Cad(_sources);
        if (found.Count == 0)
            found = among.Where(one => Answers(_objects[place(one).GameObject].Id, one)).ToList();
        return found.Count > 0 ? found : among.Where(one => Answers(_objects[place(one).GameObject].Name, one)).ToList();

        List<T> Cad(Dictionary<string, HashSet<(int GameObject, int Component)>> names) =>
            names.TryGetValue(name, out HashSet<(int GameObject, int Component)>? places) ? among.Where(one => places.Contains(place(one))).ToList() : new List<T>();

        bool Answers(string called, T one) =>
            called == name || (name.Length > called.Length && name.StartsWith(called, StringComparison.Ordinal) && name == $"{called}[{place(one).Component}]");
    }

    /// <summary>Names for a message: "there are a, b, c".</summary>
    public static string List(IReadOnlyCollection<string> names) =>
        string.Join(", ", names.Take(MostListed)) + (names.Count > MostListed ? $" and {names.Count - MostListed} more" : "");

    /// <summary>"there is a." or "there are a, b, c."</summary>
    public static string There(IReadOnlyCollection<string> names) =>
        names.Count == 0 ? "there are none." : $"there {(names.Count == 1 ? "is" : "are")} {List(names)}.";

    private void AddCadNames((int GameObject, int Component) place)
    {
        Component joint = _objects[place.GameObject].Components[place.Component];
        if (CadReading.Name(joint) is string name)
        {
            Add(_named, name, place);
            _cadNames.Add(place, name);
        }

        foreach (string source in CadReading.Sources(joint))
            Add(_sources, source, place);
    }

    private static void Add(Dictionary<string, HashSet<(int GameObject, int Component)>> names, string name, (int GameObject, int Component) place)
    {
        if (!names.TryGetValue(name, out HashSet<(int GameObject, int Component)>? places))
            names.Add(name, places = new HashSet<(int GameObject, int Component)>());
        places.Add(place);
    }

    private static bool IsTaken(Dictionary<string, HashSet<(int GameObject, int Component)>> names, string id, int gameObject) =>
        names.TryGetValue(id, out HashSet<(int GameObject, int Component)>? places) && places.Any(place => place.GameObject != gameObject);

    // Apart, so that finding an id allocates no closure.
    private int Named(string name, ref IReadOnlyList<string> several)
    {
        int[] named = Enumerable.Range(0, _objects.Count).Where(i => _objects[i].Name == name).ToArray();
        if (named.Length > 1)
            several = named.Select(i => _objects[i].Id).ToArray();
        return named.Length == 1 ? named[0] : -1;
    }
}
