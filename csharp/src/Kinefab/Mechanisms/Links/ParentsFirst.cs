using System;
using System.Collections.Generic;
using Kinefab.Document;

namespace Kinefab.Mechanisms;

/// <summary>Parents before their children, as the scene file has them; every index of an object follows.</summary>
internal static class ParentsFirst
{
    /// <summary>The same scene; objects keep their order as far as each can stand behind its parent.</summary>
    internal static SceneDocument Of(SceneDocument document)
    {
        List<int> order = Order(document.GameObjects);
        var place = new int[order.Count];
        bool isAsItWas = true;
        for (int i = 0; i < order.Count; i++)
        {
            place[order[i]] = i;
            isAsItWas &= order[i] == i;
        }

        return isAsItWas ? document : Moved(document, order, place);
    }

    // Old indices in their new order.
    private static List<int> Order(IReadOnlyList<GameObject> objects)
    {
        var order = new List<int>();
        var found = new HashSet<int>();
        var above = new List<int>();
        for (int i = 0; i < objects.Count; i++)
        {
            above.Clear();
            for (int? at = i; at is int one && found.Add(one); at = objects[one].Parent)
                above.Add(one);
            above.Reverse();
            order.AddRange(above);
        }

        return order;
    }

    private static SceneDocument Moved(SceneDocument document, List<int> order, int[] place)
    {
        int? Now(int? index) => index is int old ? place[old] : null;
        JointCoordinate Counted(JointCoordinate at) => at with { GameObject = place[at.GameObject] };
        return document with
        {
            GameObjects = Each(order, old => Moved(document.GameObjects[old], place)),
            Couplings = Each(document.Couplings, coupling => MovedCouplings.Of(coupling, Counted)),
            IgnoredCollisions = Each(document.IgnoredCollisions, pair => pair with { A = place[pair.A], B = place[pair.B] }),
            Animations = Each(document.Animations, clip => clip with { Tracks = Each(clip.Tracks, track => track with { GameObject = place[track.GameObject] }) }),
            Constraints = Each(document.Constraints, one => one with { Features = Each(one.Features, feature => feature with { GameObject = Now(feature.GameObject) }) }),
            Analysis = document.Analysis is not Analysis analysis ? null : analysis with
            {
                Islands = Each(analysis.Islands, island => island with { GameObjects = Each(island.GameObjects, old => place[old]) }),
                Bodies = Each(analysis.Bodies, body => body with { GameObject = place[body.GameObject] }),
            },
        };
    }

    private static GameObject Moved(GameObject entry, int[] place) => entry with
    {
        Parent = entry.Parent is int parent ? place[parent] : null,
        Components = Each(entry.Components, component => component is Joint { ConnectedBody: int body } joint ? joint with { ConnectedBody = place[body] } : component),
    };

    private static T[] Each<TFrom, T>(IReadOnlyList<TFrom> from, Func<TFrom, T> now)
    {
        var found = new T[from.Count];
        for (int i = 0; i < found.Length; i++)
            found[i] = now(from[i]);
        return found;
    }
}
