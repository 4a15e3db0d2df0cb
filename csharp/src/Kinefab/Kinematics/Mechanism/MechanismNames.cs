using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Joints;
using Kinefab.Mechanisms;

namespace Kinefab.Kinematics;

/// <summary>
/// Finds coordinates by what they are called: as their joint among the joints that move, and the coordinate behind it,
/// Lever/Crank:1.angle, Arm:2[3].angularX.
/// </summary>
internal sealed class MechanismNames
{
    private static readonly string[] Words = { "angle", "x", "y", "z", "angularX", "angularY", "angularZ" };

    private readonly SceneNames _names;
    private readonly MechanismCoordinate[] _coordinates;
    private readonly Dictionary<string, int> _found = new(StringComparer.Ordinal);

    public MechanismNames(IReadOnlyList<GameObject> objects, MechanismCoordinate[] coordinates)
    {
        _coordinates = coordinates;
        _names = new SceneNames(objects, coordinates.Select(Place));
        var freedoms = new Dictionary<int, int>();
        foreach (MechanismCoordinate coordinate in coordinates)
        {
            freedoms.TryGetValue(coordinate.GameObject, out int count);
            freedoms[coordinate.GameObject] = count + (coordinate.IsLocked ? 0 : 1);
        }

        for (int i = 0; i < coordinates.Length; i++)
        {
            MechanismCoordinate coordinate = coordinates[i];
            string id = objects[coordinate.GameObject].Id;
            coordinate.Name = $"{_names.Joint(coordinate.GameObject, coordinate.Component)}.{Words[(int)coordinate.Coordinate]}";
            _found.TryAdd(coordinate.Name, i);
            if (!coordinate.IsLocked && freedoms[coordinate.GameObject] == 1)
            {
                _found.TryAdd(id, i);
            }
        }

        // What an object's id and a word say by themselves is found at once, too.
        foreach (IGrouping<string, int> called in Enumerable.Range(0, coordinates.Length)
            .Where(i => !coordinates[i].IsLocked)
            .GroupBy(i => $"{objects[coordinates[i].GameObject].Id}.{Words[(int)coordinates[i].Coordinate]}"))
        {
            if (called.Count() == 1)
            {
                _found.TryAdd(called.Key, called.First());
            }
        }
    }

    /// <summary>By id, else by a name that no other object has; -1: none.</summary>
    public int GameObject(string name) => _names.GameObject(name);

    /// <summary>By its name, or by as much of it as no other coordinate answers to; the object's name does for its id.</summary>
    public bool TryFind(string name, out int coordinate, out string problem)
    {
        problem = "";
        return _found.TryGetValue(name, out coordinate) || TryMatch(name, out coordinate, out problem);
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
    private List<int> Called(string name) =>
        _names.Called(name, Enumerable.Range(0, _coordinates.Length).Where(i => !_coordinates[i].IsLocked).ToList(), i => Place(_coordinates[i]));

    private static (int GameObject, int Component) Place(MechanismCoordinate coordinate) => (coordinate.GameObject, coordinate.Component);

    private string List(IEnumerable<int> coordinates) => SceneNames.List(coordinates.Select(i => _coordinates[i].Name).ToList());
}
