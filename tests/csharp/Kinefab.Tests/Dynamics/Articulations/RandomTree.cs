using System;
using System.Linq;
using Kinefab.Dynamics.Articulations;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Articulations;

/// <summary>A random articulation with random positions and speeds of its joints.</summary>
internal static class RandomTree
{
    public static ArticulationTree Make(int seed, int mostLinks = 24)
    {
        var random = new Random(seed);
        int count = random.Next(1, mostLinks + 1);
        int[] parents = Enumerable.Range(0, count).Select(i => i == 0 ? -1 : random.Next(Math.Max(0, i - 4), i)).ToArray();
        int[] order = ArticulationTree.DepthFirst(parents);
        LinkDefinition[] links = order.Select(old => Link(random, parents[old] < 0 ? -1 : Array.IndexOf(order, parents[old]))).ToArray();
        var tree = new ArticulationTree(links, Pose(random), isFixed: random.Next(2) == 0);
        for (int f = 0; f < tree.Freedoms; f++)
        {
            tree.Positions[f] = Between(random, -1, 1);
            tree.Speeds[f] = Between(random, -3, 3);
        }

        if (!tree.IsFixed)
            tree.Motions[0] = new Twist(Vector(random, 2), Vector(random, 2));
        TreeKinematics.Place(tree);
        TreeKinematics.Move(tree);
        return tree;
    }

    public static double Between(Random random, double least, double most) => least + (most - least) * random.NextDouble();

    public static Vector3d Vector(Random random, double size) => new(Between(random, -size, size), Between(random, -size, size), Between(random, -size, size));

    private static LinkDefinition Link(Random random, int parent)
    {
        double mass = Between(random, 0.2, 4);
        double a = Between(random, 0.05, 0.5), b = Between(random, 0.05, 0.5), c = Between(random, 0.05, 0.5);
        var link = new LinkDefinition
        {
            Parent = parent,
            Mass = mass,
            Inertia = new Vector3d(b * b + c * c, a * a + c * c, a * a + b * b) * (mass / 12),
            Joint = (LinkJointKind)random.Next(4),
            ParentAnchor = Pose(random),
            Anchor = Pose(random),
            UseGravity = random.Next(5) > 0,
        };
        for (int axis = 0; axis < 3; axis++)
            link.Axes[axis].Motion = axis == 0 || random.Next(2) == 0 ? LinkMotion.Free : LinkMotion.Locked;
        return link;
    }

    private static Pose Pose(Random random) => new(Vector(random, 0.5), TreeKinematics.Turn(Vector(random, 2)));
}
