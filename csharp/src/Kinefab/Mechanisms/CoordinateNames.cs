using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;

namespace Kinefab.Mechanisms;

/// <summary>A coordinate of a joint component.</summary>
internal readonly struct CoordinatePlace
{
    public readonly int GameObject;
    public readonly int Component;
    public readonly Coordinate Coordinate;

    /// <summary>The joint holds it still.</summary>
    public readonly bool IsLocked;

    public CoordinatePlace(int gameObject, int component, Coordinate coordinate, bool isLocked)
    {
        GameObject = gameObject;
        Component = component;
        Coordinate = coordinate;
        IsLocked = isLocked;
    }
}

/// <summary>
/// Finds coordinates by what they are called: as their joint among the joints that move, and the coordinate behind it,
/// Lever/Crank:1.angle, Arm:2[3].angularX, Shaft.angle; or by as much of it as no other coordinate answers to.
/// </summary>
internal sealed class CoordinateNames
{
    private static readonly string[] Words = { "angle", "x", "y", "z", "angularX", "angularY", "angularZ" };

    private readonly SceneNames _names;
    private readonly CoordinatePlace[] _coordinates;
    private readonly string[] _full;
    private readonly int[] _moving;
    private readonly Dictionary<string, int> _found = new(StringComparer.Ordinal);

    public CoordinateNames(IReadOnlyList<GameObject> objects, CoordinatePlace[] coordinates)
    {
        _coordinates = coordinates;
        _names = new SceneNames(objects, coordinates.Select(Place));
        _moving = Enumerable.Range(0, coordinates.Length).Where(i => !coordinates[i].IsLocked).ToArray();
        var freedoms = new Dictionary<(int GameObject, int Component), int>();
        foreach (CoordinatePlace coordinate in coordinates)
        {
            freedoms.TryGetValue((coordinate.GameObject, coordinate.Component), out int count);
            freedoms[(coordinate.GameObject, coordinate.Component)] = count + (coordinate.IsLocked ? 0 : 1);
        }

        _full = new string[coordinates.Length];
        for (int i = 0; i < coordinates.Length; i++)
        {
            CoordinatePlace coordinate = coordinates[i];
            string joint = _names.Joint(coordinate.GameObject, coordinate.Component);
            _full[i] = $"{joint}.{Words[(int)coordinate.Coordinate]}";
            _found.TryAdd(_full[i], i);
            if (!coordinate.IsLocked && freedoms[(coordinate.GameObject, coordinate.Component)] == 1)
            {
                _found.TryAdd(joint, i);
            }
        }

        // What the CAD's name, an object's id, and a word behind either say by themselves is found at once, too.
        AddAlone(i => _names.NameInCad(coordinates[i].GameObject, coordinates[i].Component));
        AddAlone(i => _names.NameInCad(coordinates[i].GameObject, coordinates[i].Component) is string name ? $"{name}.{Words[(int)coordinates[i].Coordinate]}" : null);
        AddAlone(i => _names.IsNameInCad(objects[coordinates[i].GameObject].Id) ? null : $"{objects[coordinates[i].GameObject].Id}.{Words[(int)coordinates[i].Coordinate]}");
    }

    /// <summary>What a coordinate is called in files and messages.</summary>
    public string this[int coordinate] => _full[coordinate];

    /// <summary>The CAD's name if it finds the coordinate, with the coordinate behind it where the joint has several; else the joint's; else the full name.</summary>
    public string Short(int coordinate)
    {
        CoordinatePlace place = _coordinates[coordinate];
        string cad = _names.NameInCad(place.GameObject, place.Component) ?? "";
        string[] names = { cad, $"{cad}.{Words[(int)place.Coordinate]}", _names.Joint(place.GameObject, place.Component) };
        return Array.Find(names, name => _found.TryGetValue(name, out int found) && found == coordinate) ?? _full[coordinate];
    }

    /// <summary>As <see cref="SceneNames.GameObject"/>.</summary>
    public int GameObject(string name, out IReadOnlyList<string> several) => _names.GameObject(name, out several);

    /// <summary>By its name, or by as much of it as no other coordinate answers to.</summary>
    /// <param name="name">Such as Shaft, Lever/Crank:1, Arm.angularX or Arm[3].angularX.</param>
    /// <param name="coordinate">Its index; -1: none, or several.</param>
    /// <param name="problem">What is wrong with the name and which there are; empty: nothing.</param>
    public bool TryFind(string name, out int coordinate, out string problem)
    {
        problem = "";
        return _found.TryGetValue(name, out coordinate) || TryMatch(name, out coordinate, out problem);
    }

    private void AddAlone(Func<int, string?> name)
    {
        foreach (IGrouping<string?, int> called in _moving.GroupBy(name))
        {
            if (called.Key is string alone && called.Count() == 1)
            {
                _found.TryAdd(alone, called.First());
            }
        }
    }

    private bool TryMatch(string name, out int coordinate, out string problem)
    {
        List<int> found = Called(name);
        int dot = name.LastIndexOf('.');
        if (found.Count == 0 && dot > 0)
        {
            int word = Array.FindIndex(Words, w => string.Equals(w, name[(dot + 1)..], StringComparison.OrdinalIgnoreCase));
            found = Called(name[..dot]).Where(i => (int)_coordinates[i].Coordinate == word).ToList();
        }

        coordinate = found.Count == 1 ? found[0] : -1;
        problem = found.Count switch
        {
            1 => "",
            0 => Absent(name, dot),
            _ => $"say which: {List(found)}.",
        };
        return found.Count == 1;
    }

    // Says most where the joint is there and only its coordinate is not.
    private string Absent(string name, int dot)
    {
        List<int> joint = dot > 0 ? Called(name[..dot]) : new List<int>();
        if (joint.Count > 0)
        {
            string word = name[(dot + 1)..];
            string fault = Words.Contains(word, StringComparer.OrdinalIgnoreCase) ? $"the joint does not move along {word}" : $"{word} is no coordinate";
            return $"{fault}; the joint has {string.Join(", ", joint.Select(i => Words[(int)_coordinates[i].Coordinate]).Distinct())}.";
        }

        return _coordinates.Length == 0
            ? "no joint of the scene moves."
            : $"no joint moves by this name; there {(_coordinates.Length == 1 ? "is" : "are")} {List(Enumerable.Range(0, _coordinates.Length))}.";
    }

    // An id may hold dots itself, so the whole is tried for an object before its last part is taken for a coordinate.
    private List<int> Called(string name) => _names.Called(name, _moving, i => Place(_coordinates[i]));

    private static (int GameObject, int Component) Place(CoordinatePlace coordinate) => (coordinate.GameObject, coordinate.Component);

    private string List(IEnumerable<int> coordinates) =>
        SceneNames.List(coordinates.Select(i => _full[i] + _names.InWords(_coordinates[i].GameObject, _coordinates[i].Component)).ToList());
}
