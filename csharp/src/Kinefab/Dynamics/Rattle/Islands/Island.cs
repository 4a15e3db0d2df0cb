using System.Collections.Generic;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Moving bodies that hang together by joints and couplings, with the fixed bodies they touch, and their matrix's pattern.</summary>
internal sealed class Island
{
    /// <summary>A body couples the rows of two nodes: the block (Later, Earlier) takes J_l M^-1 J_e^T over it.</summary>
    internal readonly struct Link
    {
        public Link(int later, int laterSide, int earlier, int earlierSide, int body, int block)
        {
            Later = later;
            LaterSide = laterSide;
            Earlier = earlier;
            EarlierSide = earlierSide;
            Body = body;
            Block = block;
        }

        public readonly int Later;
        public readonly int LaterSide;
        public readonly int Earlier;
        public readonly int EarlierSide;
        public readonly int Body;
        public readonly int Block;
    }

    /// <param name="bodies">Index in the mechanism (or Joint.World) of each body, the moving ones first.</param>
    /// <param name="movingBodies">How many move.</param>
    /// <param name="nodes">Joints and couplings, their bodies as in the first list.</param>
    /// <param name="inverseInertias">Of the mechanism's bodies, about principal axes, 1/(kg m^2).</param>
    public Island(int[] bodies, int movingBodies, Node[] nodes, Vector3d[] inverseInertias)
    {
        Bodies = bodies;
        MovingBodies = movingBodies;
        Nodes = nodes;
        IsStatic = new bool[bodies.Length];
        for (int b = 0; b < bodies.Length; b++)
        {
            IsStatic[b] = bodies[b] == JointModel.World;
        }

        var sizes = new int[nodes.Length];
        var touching = new List<(int Node, int Side)>[movingBodies];
        for (int b = 0; b < movingBodies; b++)
        {
            touching[b] = new List<(int Node, int Side)>();
        }

        for (int n = 0; n < nodes.Length; n++)
        {
            sizes[n] = nodes[n].Rows;
            HasPreparedRows |= nodes[n].IsPrepared;
            Laws += nodes[n].Laws;
            for (int side = 0; side < nodes[n].Bodies.Length; side++)
            {
                int body = nodes[n].Bodies[side];
                if (body < movingBodies)
                {
                    touching[body].Add((n, side));
                }
            }
        }

        IsWorkless = System.Array.IndexOf(IsStatic, false, movingBodies) < 0;
        Spins = new Spin[movingBodies];
        for (int b = 0; b < movingBodies; b++)
        {
            Spins[b] = new Spin(inverseInertias[bodies[b]]);
        }

        FrozenBodies = FindFrozen(bodies, movingBodies, inverseInertias);
        RatedBodies = FindRated(nodes, movingBodies);
        Pattern = new BlockPattern(sizes, Couplings(touching));
        Links = MakeLinks(touching, Pattern);
        IsAngular = new bool[Pattern.RowCount];
        for (int n = 0; n < nodes.Length; n++)
        {
            for (int i = 0; i < nodes[n].Rows; i++)
            {
                IsAngular[Pattern.Rows[n] + i] = nodes[n].IsLockedAngle(i);
            }
        }
    }

    /// <summary>Index in the mechanism (or Joint.World) of each of the island's bodies, the moving ones first.</summary>
    public int[] Bodies { get; }

    public int MovingBodies { get; }

    /// <summary>Whether a body is the world; the other fixed ones are kinematic.</summary>
    public bool[] IsStatic { get; }

    /// <summary>How each moving body's rotation is split.</summary>
    public Spin[] Spins { get; }

    public Node[] Nodes { get; }

    public BlockPattern Pattern { get; }

    public Link[] Links { get; }

    /// <summary>Whether nothing but the bodies' own forces does work on them: no law, no kinematic body.</summary>
    public bool IsWorkless { get; }

    /// <summary>Whether there are more joints and couplings than it takes to hang up the bodies, all that does not move being one.</summary>
    public bool HasLoops => Nodes.Length >= MovingBodies + (Bodies.Length > MovingBodies ? 1 : 0);

    /// <summary>Whether rows may repeat each other or ask for a turn that a body does not make: by loops or by infinite moments.</summary>
    public bool IsRedundant => HasLoops || FrozenBodies.Length > 0;

    /// <summary>Moving bodies with an infinite moment of inertia.</summary>
    public int[] FrozenBodies { get; }

    /// <summary>Moving bodies of joints with a law, whose mean rates in the flight the laws ask for.</summary>
    public int[] RatedBodies { get; }

    /// <summary>How well its loops close: see <see cref="LoopProbe"/>.</summary>
    public LoopFit Fit { get; set; }

    public bool IsInexact => Fit == LoopFit.Inexact;

    /// <summary>Whether a row, in the vectors' order, locks an angle.</summary>
    public bool[] IsAngular { get; }

    /// <summary>Rows with a law, of all nodes.</summary>
    public int Laws { get; }

    /// <summary>Whether some rows have no closed form in lanes.</summary>
    public bool HasPreparedRows { get; }

    /// <summary>Whether the other island is of the same build, so that both can share lanes.</summary>
    public bool HasShapeOf(Island other)
    {
        if (Bodies.Length != other.Bodies.Length || MovingBodies != other.MovingBodies || Nodes.Length != other.Nodes.Length
            || Fit != other.Fit)
        {
            return false;
        }

        for (int b = 0; b < IsStatic.Length; b++)
        {
            if (IsStatic[b] != other.IsStatic[b])
            {
                return false;
            }
        }

        if (FrozenBodies.Length != other.FrozenBodies.Length)
        {
            return false;
        }

        for (int b = 0; b < FrozenBodies.Length; b++)
        {
            if (FrozenBodies[b] != other.FrozenBodies[b])
            {
                return false;
            }
        }

        for (int b = 0; b < MovingBodies; b++)
        {
            if (!Spins[b].Equals(other.Spins[b]))
            {
                return false;
            }
        }

        for (int n = 0; n < Nodes.Length; n++)
        {
            if (!Nodes[n].HasShapeOf(other.Nodes[n]))
            {
                return false;
            }
        }

        return true;
    }

    private static int[] FindRated(Node[] nodes, int movingBodies)
    {
        var rated = new SortedSet<int>();
        foreach (Node node in nodes)
        {
            if (node.Laws > 0)
            {
                rated.UnionWith(node.Bodies);
            }
        }

        rated.RemoveWhere(body => body >= movingBodies);
        return new List<int>(rated).ToArray();
    }

    private static int[] FindFrozen(int[] bodies, int movingBodies, Vector3d[] inverseInertias)
    {
        var frozen = new List<int>();
        for (int b = 0; b < movingBodies; b++)
        {
            Vector3d inverse = inverseInertias[bodies[b]];
            if (inverse.X == 0 || inverse.Y == 0 || inverse.Z == 0)
            {
                frozen.Add(b);
            }
        }

        return frozen.ToArray();
    }

    private static IEnumerable<(int A, int B)> Couplings(List<(int Node, int Side)>[] touching)
    {
        foreach (List<(int Node, int Side)> nodes in touching)
        {
            for (int i = 0; i < nodes.Count; i++)
            {
                for (int k = 0; k < i; k++)
                {
                    yield return (nodes[i].Node, nodes[k].Node);
                }
            }
        }
    }

    private static Link[] MakeLinks(List<(int Node, int Side)>[] touching, BlockPattern pattern)
    {
        var links = new List<Link>();
        for (int body = 0; body < touching.Length; body++)
        {
            List<(int Node, int Side)> nodes = touching[body];
            for (int i = 0; i < nodes.Count; i++)
            {
                for (int k = 0; k < i; k++)
                {
                    (int later, int laterSide) = nodes[i];
                    (int earlier, int earlierSide) = nodes[k];
                    if (pattern.IsBefore(later, earlier))
                    {
                        (later, laterSide, earlier, earlierSide) = (earlier, earlierSide, later, laterSide);
                    }

                    links.Add(new Link(later, laterSide, earlier, earlierSide, body, pattern.Below(later, earlier)));
                }
            }
        }

        return links.ToArray();
    }
}
