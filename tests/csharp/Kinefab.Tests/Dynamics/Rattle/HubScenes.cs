using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Scenes with many joints on few bodies, and a grid of closed cells. Lengths in metres, no two masses or moments alike where it matters.</summary>
internal static class HubScenes
{
    /// <summary>The shapes, by about the number of their joints.</summary>
    internal static readonly IReadOnlyDictionary<string, Func<int, SceneDocument>> Kinds = new Dictionary<string, Func<int, SceneDocument>>
    {
        ["star"] = Star,
        ["pair"] = Pair,
        ["comb"] = Comb,
        ["grid"] = joints => Grid((int)Math.Round(Math.Sqrt(joints / 2.0))),
    };

    private const int TeethOfATooth = 32;

    /// <summary>A hub that turns about the world's Y, and hinges of leaves around it.</summary>
    internal static SceneDocument Star(int joints)
    {
        var bodies = new List<GameObject> { Body(0, Vector3d.Zero, Hinge(null, Vector3d.UnitY, Vector3d.Zero)) };
        while (bodies.Count < joints)
        {
            int i = bodies.Count;
            var place = new Vector3d(i % 37 + 1, 0.1 * (i / 37), 0.3 * (i % 5));
            bodies.Add(Body(i, place, Hinge(0, new Vector3d(0.1 * (i % 3), 0, 1), new Vector3d(-0.2, 0.1 * (i % 4), 0))));
        }

        return new SceneDocument { GameObjects = bodies };
    }

    /// <summary>A body that turns about the world's Y, and one on hinges of one axis to it: all but the first repeat it.</summary>
    internal static SceneDocument Pair(int joints)
    {
        var hinges = new HingeJoint[joints - 1];
        for (int i = 0; i < hinges.Length; i++)
        {
            hinges[i] = Hinge(0, Vector3d.UnitZ, new Vector3d(-1, 0, 0.01 * i));
        }

        return new SceneDocument { GameObjects = [Body(0, Vector3d.Zero, Hinge(null, Vector3d.UnitY, Vector3d.Zero)), Body(1, Vector3d.UnitX, hinges)] };
    }

    /// <summary>A chain of bodies with teeth hinged to each.</summary>
    internal static SceneDocument Comb(int joints)
    {
        var bodies = new List<GameObject>();
        int? spine = null;
        while (bodies.Count < joints)
        {
            int back = bodies.Count;
            Vector3d place = 2.0 * (back / TeethOfATooth) * Vector3d.UnitX;
            bodies.Add(Body(back, place, Hinge(spine, Vector3d.UnitZ, -Vector3d.UnitX)));
            for (int tooth = 0; tooth < TeethOfATooth && bodies.Count < joints; tooth++)
            {
                var axis = new Vector3d(0, 0.1 * (tooth % 3), 1);
                bodies.Add(Body(bodies.Count, place + new Vector3d(0.05 * tooth, -1, 0), Hinge(back, axis, new Vector3d(0, 0.5, 0))));
            }

            spine = back;
        }

        return new SceneDocument { GameObjects = bodies };
    }

    /// <summary>So many by so many closed cells, of plates hinged at the middles of their sides.</summary>
    internal static SceneDocument Grid(int cells)
    {
        int width = cells + 1;
        var bodies = new List<GameObject>();
        for (int y = 0; y < width; y++)
        {
            for (int x = 0; x < width; x++)
            {
                var joints = new List<Component>();
                if (x > 0)
                {
                    joints.Add(Hinge(bodies.Count - 1, Vector3d.UnitZ, new Vector3d(-0.5, 0, 0)));
                }

                if (y > 0)
                {
                    joints.Add(Hinge(bodies.Count - width, Vector3d.UnitZ, new Vector3d(0, -0.5, 0)));
                }

                if (joints.Count == 0)
                {
                    joints.Add(new FixedJoint());
                }

                bodies.Add(Body(bodies.Count, new Vector3d(x, y, 0), joints.ToArray()));
            }
        }

        return new SceneDocument { GameObjects = bodies };
    }

    private static GameObject Body(int index, Vector3d place, params Component[] joints) => new()
    {
        Id = $"b{index}",
        Name = $"b{index}",
        Transform = new Transform { LocalPosition = place },
        Components = [new Rigidbody { Mass = 1 + 0.01 * (index % 7), InertiaTensor = new Vector3d(1, 1.1, 0.9), AngularDamping = 0 }, .. joints],
    };

    private static HingeJoint Hinge(int? other, Vector3d axis, Vector3d anchor) => new() { ConnectedBody = other, Axis = axis, Anchor = anchor };
}
