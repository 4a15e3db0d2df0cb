using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Mechanisms;

namespace Kinefab.Dynamics;

/// <summary>Finds the bodies, joints and coordinates of a world by what they are called; gives the joints their names.</summary>
internal sealed class WorldNames
{
    private readonly SceneNames _names;
    private readonly WorldJoint[] _joints;
    private readonly Dictionary<int, WorldBody> _bodyOf;
    private readonly Dictionary<string, WorldJoint> _jointsByName = new(StringComparer.Ordinal);
    private readonly (WorldJoint Joint, Coordinate Coordinate)[] _coordinates;

    // Most worlds are never asked for one.
    private readonly Lazy<CoordinateNames> _coordinateNames;

    public WorldNames(IReadOnlyList<GameObject> objects, WorldBody[] bodies, WorldJoint[] joints)
    {
        _names = new SceneNames(objects, joints.Select(Place));
        _joints = joints;
        _bodyOf = bodies.ToDictionary(body => body.GameObject);
        foreach (WorldJoint joint in joints)
        {
            joint.Name = _names.Joint(joint.GameObject, joint.Component);
            joint.NameInCad = _names.NameInCad(joint.GameObject, joint.Component);
            _jointsByName.TryAdd(joint.Name, joint);
        }

        _coordinates = joints.SelectMany(joint => joint.FreeCoordinates, (joint, coordinate) => (joint, coordinate)).ToArray();
        _coordinateNames = new Lazy<CoordinateNames>(() => new CoordinateNames(objects, Array.ConvertAll(_coordinates, c => new CoordinatePlace(c.Joint.GameObject, c.Joint.Component, c.Coordinate, isLocked: false))));
    }

    public WorldBody Body(string name)
    {
        int found = _names.GameObject(name, out IReadOnlyList<string> several);
        if (found >= 0 && _bodyOf.TryGetValue(found, out WorldBody? body))
            return body;
        throw new ArgumentException(
            several.Count > 0
                ? $"{name}: say which: {SceneNames.List(several)}."
                : $"{name}: no body has this id, nor one alone this name; {SceneNames.There(_bodyOf.Values.Select(b => b.Id).ToList())}",
            nameof(name));
    }

    public WorldJoint Joint(string name)
    {
        if (_jointsByName.TryGetValue(name, out WorldJoint? joint))
        {
            return joint;
        }

        List<WorldJoint> found = _names.Called(name, _joints, Place);
        return found.Count switch
        {
            1 => found[0],
            0 => throw new ArgumentException($"{name}: no joint has this name; {SceneNames.There(Array.ConvertAll(_joints, InWords))}", nameof(name)),
            _ => throw new ArgumentException($"{name}: say which: {SceneNames.List(found.ConvertAll(InWords))}.", nameof(name)),
        };
    }

    public (WorldJoint Joint, Coordinate Coordinate) Coordinate(string name) => _coordinateNames.Value.TryFind(name, out int found, out string problem)
        ? _coordinates[found]
        : throw new ArgumentException($"{name}: {problem}", nameof(name));

    private string InWords(WorldJoint joint) => joint.Name + _names.InWords(joint.GameObject, joint.Component);

    private static (int GameObject, int Component) Place(WorldJoint joint) => (joint.GameObject, joint.Component);
}
