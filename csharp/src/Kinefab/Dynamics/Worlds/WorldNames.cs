using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Joints;
using Kinefab.Mechanisms;

namespace Kinefab.Dynamics;

/// <summary>Finds the bodies and joints of a world by what they are called; gives the joints their names.</summary>
internal sealed class WorldNames
{
    private readonly SceneNames _names;
    private readonly WorldJoint[] _joints;
    private readonly Dictionary<int, WorldBody> _bodyOf;
    private readonly Dictionary<string, WorldJoint> _jointsByName = new(StringComparer.Ordinal);

    public WorldNames(IReadOnlyList<GameObject> objects, WorldBody[] bodies, WorldJoint[] joints)
    {
        _names = new SceneNames(objects, joints.Select(Place));
        _joints = joints;
        _bodyOf = bodies.ToDictionary(body => body.GameObject);
        foreach (WorldJoint joint in joints)
        {
            joint.Name = _names.Joint(joint.GameObject, joint.Component);
            _jointsByName.TryAdd(joint.Name, joint);
        }
    }

    public WorldBody Body(string name)
    {
        int found = _names.GameObject(name);
        return found >= 0 && _bodyOf.TryGetValue(found, out WorldBody? body)
            ? body
            : throw new ArgumentException($"{name}: no body has this id, nor one alone this name; {There(_bodyOf.Values.Select(b => b.Id))}", nameof(name));
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
            0 => throw new ArgumentException($"{name}: no joint has this name; {There(_joints.Select(j => j.Name))}", nameof(name)),
            _ => throw new ArgumentException($"{name}: say which: {SceneNames.List(found.ConvertAll(j => j.Name))}.", nameof(name)),
        };
    }

    private static (int GameObject, int Component) Place(WorldJoint joint) => (joint.GameObject, joint.Component);

    private static string There(IEnumerable<string> names)
    {
        List<string> all = names.ToList();
        return all.Count == 0 ? "there are none." : $"there {(all.Count == 1 ? "is" : "are")} {SceneNames.List(all)}.";
    }
}
