using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;

namespace Kinefab.Advice.Runs;

/// <summary>Bodies that hang together by joints; what happens in one island has no effect on another.</summary>
internal sealed class RunIsland
{
    private readonly HashSet<int> _gameObjects;
    private readonly HashSet<(int GameObject, int Component)> _components;

    private RunIsland(World world, int index, int[] bodies, int[] joints, bool isFloating)
    {
        Index = index;
        IsFloating = isFloating;
        _components = new HashSet<(int, int)>(joints.Select(j => (world.Joints[j].GameObject, world.Joints[j].Component)));
        _gameObjects = new HashSet<int>(bodies.Select(b => world.Bodies[b].GameObject).Concat(_components.Select(c => c.GameObject)));
        Bodies = bodies;
        Joints = joints;
        Length = LinkLength(world, bodies, joints);
    }

    public int Index { get; }

    /// <summary>Indices of the world's bodies, kinematic ones left out.</summary>
    public int[] Bodies { get; }

    /// <summary>Indices of the world's joints.</summary>
    public int[] Joints { get; }

    /// <summary>About the length of a link, metres: twice the mean distance of joints, or the radius of gyration, from the centre of mass.</summary>
    public double Length { get; }

    /// <summary>Whether nothing ties it to the world or to a kinematic body, so that it falls.</summary>
    public bool IsFloating { get; }

    /// <summary>Whether a GameObject bears a body or a joint of it; a kinematic one may bear joints of several islands.</summary>
    public bool Holds(int gameObject) => _gameObjects.Contains(gameObject);

    /// <summary>Whether a joint belongs to it.</summary>
    public bool Holds(int gameObject, int component) => _components.Contains((gameObject, component));

    /// <summary>The islands of a world, by their first body.</summary>
    public static List<RunIsland> Of(World world, IReadOnlyList<Coupling> couplings)
    {
        var sets = new DisjointSets(world.Bodies.Count);
        var joints = world.Joints.ToDictionary(j => (j.GameObject, j.Component));
        foreach (WorldJoint joint in world.Joints)
            Join(joint, joint);
        foreach (Coupling coupling in couplings)
        {
            var coupled = new List<WorldJoint>();
            foreach (JointCoordinate at in coupling.Followed.Select(term => term.Coordinate).Append(coupling.B))
            {
                if (joints.TryGetValue((at.GameObject, at.Component), out WorldJoint? joint))
                    coupled.Add(joint);
            }

            // One of an inactive object's joint is none.
            if (coupled.Count <= coupling.Followed.Count)
                continue;
            foreach (WorldJoint joint in coupled)
                Join(coupled[0], joint);
        }

        ILookup<int, int> jointsOf = world.Joints.Where(j => Moving(j).Any()).ToLookup(j => sets.Find(Moving(j).First()), j => j.Index);
        return Enumerable.Range(0, world.Bodies.Count).Where(b => !world.Bodies[b].IsKinematic).GroupBy(sets.Find)
            .Where(bodies => jointsOf.Contains(bodies.Key))
            .Select((bodies, index) => new RunIsland(
                world, index, bodies.ToArray(), jointsOf[bodies.Key].ToArray(), jointsOf[bodies.Key].All(j => Moving(world.Joints[j]).Count() == 2)))
            .ToList();

        void Join(WorldJoint a, WorldJoint b)
        {
            foreach (int body in Moving(a).Concat(Moving(b)))
                sets.Join(Moving(a).Concat(Moving(b)).First(), body);
        }

        IEnumerable<int> Moving(WorldJoint joint) => new[] { joint.Solved.Body0, joint.Solved.Body1 }.Where(b => b >= 0 && !world.Bodies[b].IsKinematic);
    }

    private static double LinkLength(World world, IEnumerable<int> bodies, IEnumerable<int> joints)
    {
        var squares = new Dictionary<int, double>();
        foreach (int b in bodies)
        {
            Rigidbody body = world.Bodies[b].Settings;
            squares[b] = (body.InertiaTensor.X + body.InertiaTensor.Y + body.InertiaTensor.Z) / (2 * body.Mass);
        }

        foreach (int j in joints)
        {
            Kinefab.Joints.JointModel joint = world.Joints[j].Solved;
            Raise(joint.Body0, joint.Frame0.Position.LengthSquared);
            Raise(joint.Body1, joint.Frame1.Position.LengthSquared);
        }

        return squares.Count == 0 ? 1 : 2 * squares.Values.Average(Math.Sqrt);

        void Raise(int body, double square)
        {
            if (squares.TryGetValue(body, out double known))
                squares[body] = Math.Max(known, square);
        }
    }
}
