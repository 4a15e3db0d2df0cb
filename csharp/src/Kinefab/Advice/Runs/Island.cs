using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Dynamics;
using Kinefab.Kinematics;

namespace Kinefab.Advice.Runs;

/// <summary>Bodies that hang together; what happens in one has no effect on another.</summary>
internal sealed class Island
{
    private readonly HashSet<int> _gameObjects;

    private Island(int index, IslandMobility mobility, int[] bodies, int[] joints, double length)
    {
        Index = index;
        _gameObjects = new HashSet<int>(mobility.GameObjects);
        Bodies = bodies;
        Joints = joints;
        Length = length;
    }

    public int Index { get; }

    /// <summary>Indices of the world's bodies, kinematic ones left out.</summary>
    public int[] Bodies { get; }

    /// <summary>Indices of the world's joints.</summary>
    public int[] Joints { get; }

    /// <summary>About the length of a link, metres: twice the mean distance of joints, or the radius of gyration, from the centre of mass.</summary>
    public double Length { get; }

    /// <summary>Whether a GameObject's Rigidbody belongs to it.</summary>
    public bool Holds(int gameObject) => _gameObjects.Contains(gameObject);

    public static List<Island> Of(World world, MobilityReport mobility)
    {
        var islands = new List<Island>();
        var islandOf = new Dictionary<int, int>();
        for (int i = 0; i < mobility.Islands.Count; i++)
        {
            foreach (int gameObject in mobility.Islands[i].GameObjects)
                islandOf[gameObject] = i;
        }

        ILookup<int, int> bodies = Enumerable.Range(0, world.Bodies.Count).ToLookup(b => At(world.Bodies[b].GameObject));
        ILookup<int, int> joints = Enumerable.Range(0, world.Joints.Count).ToLookup(j => OfJoint(world.Joints[j]));
        for (int i = 0; i < mobility.Islands.Count; i++)
            islands.Add(new Island(i, mobility.Islands[i], bodies[i].ToArray(), joints[i].ToArray(), LinkLength(world, bodies[i], joints[i])));
        return islands;

        int At(int gameObject) => islandOf.TryGetValue(gameObject, out int island) ? island : -1;

        int OfJoint(WorldJoint joint)
        {
            int own = BodyIsland(joint.Solved.Body0);
            return own >= 0 ? own : BodyIsland(joint.Solved.Body1);
        }

        int BodyIsland(int body) => body < 0 ? -1 : At(world.Bodies[body].GameObject);
    }

    private static double LinkLength(World world, IEnumerable<int> bodies, IEnumerable<int> joints)
    {
        var squares = new Dictionary<int, double>();
        foreach (int b in bodies)
        {
            Document.Rigidbody body = world.Bodies[b].Settings;
            squares[b] = (body.InertiaTensor.X + body.InertiaTensor.Y + body.InertiaTensor.Z) / (2 * body.Mass);
        }

        foreach (int j in joints)
        {
            Joints.Joint joint = world.Joints[j].Solved;
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
