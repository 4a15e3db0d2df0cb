using System;
using System.Collections.Generic;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Moving bodies that hang together by joints and couplings, with the fixed bodies they touch, and their matrix's pattern.</summary>
internal sealed class Island
{
    /// <summary>A body couples the rows of two blocks: the block (Later, Earlier) takes J_l M^-1 J_e^T over it.</summary>
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

    // A body of n joints couples n^2 pairs of them: the pattern is built when it is first asked for, since Unity's solver, and an
    // island that is only looked at for loops, do without.
    private readonly int[] _sizes;
    private readonly List<(int Node, int Side)>[] _touching;
    private BlockPattern? _pattern;
    private Link[]? _links;
    private bool[]? _isAngular;

    /// <param name="bodies">Index in the mechanism (or Joint.World) of each body, the moving ones first.</param>
    /// <param name="movingBodies">How many move.</param>
    /// <param name="blocks">Joints and couplings, their bodies as in the first list.</param>
    /// <param name="inverseInertias">Of the mechanism's bodies, about principal axes, 1/(kg m^2).</param>
    public Island(int[] bodies, int movingBodies, RowBlock[] blocks, Vector3d[] inverseInertias)
    {
        Bodies = bodies;
        MovingBodies = movingBodies;
        Blocks = blocks;
        IsStatic = new bool[bodies.Length];
        for (int b = 0; b < bodies.Length; b++)
        {
            IsStatic[b] = bodies[b] == JointModel.World;
        }

        var sizes = new int[blocks.Length];
        var touching = new List<(int Node, int Side)>[movingBodies];
        for (int b = 0; b < movingBodies; b++)
        {
            touching[b] = new List<(int Node, int Side)>();
        }

        for (int n = 0; n < blocks.Length; n++)
        {
            sizes[n] = blocks[n].Rows;
            HasAssembledRows |= blocks[n].IsAssembled;
            ScalarCount += blocks[n].ScalarCount;
            for (int side = 0; side < blocks[n].Bodies.Length; side++)
            {
                int body = blocks[n].Bodies[side];
                if (body < movingBodies)
                {
                    touching[body].Add((n, side));
                }
            }
        }

        HasKinematic = Array.IndexOf(IsStatic, false, movingBodies) >= 0;
        RotationSplittings = new RotationSplitting[movingBodies];
        for (int b = 0; b < movingBodies; b++)
        {
            RotationSplittings[b] = new RotationSplitting(inverseInertias[bodies[b]]);
        }

        LockedInertiaBodies = FindLockedInertia(bodies, movingBodies, inverseInertias);
        MeanRateBodies = FindMeanRate(blocks, movingBodies);
        _sizes = sizes;
        _touching = touching;
    }

    /// <summary>Index in the mechanism (or Joint.World) of each of the island's bodies, the moving ones first.</summary>
    public int[] Bodies { get; }

    public int MovingBodies { get; }

    /// <summary>Whether a body is the world; the other fixed ones are kinematic.</summary>
    public bool[] IsStatic { get; }

    /// <summary>How each moving body's rotation is split.</summary>
    public RotationSplitting[] RotationSplittings { get; }

    public RowBlock[] Blocks { get; }

    public BlockPattern Pattern => _pattern ??= new BlockPattern(_sizes, Couplings(_touching));

    public Link[] Links => _links ??= MakeLinks(_touching, Pattern);

    /// <summary>Whether a body of theirs moves as it is told.</summary>
    public bool HasKinematic { get; }

    /// <summary>Whether there are more joints and couplings than it takes to hang up the bodies, all that does not move being one.</summary>
    public bool HasLoops => Blocks.Length >= MovingBodies + (Bodies.Length > MovingBodies ? 1 : 0);

    /// <summary>Whether rows may repeat each other or ask for a turn that a body does not make: by loops or by infinite moments.</summary>
    public bool IsRedundant => HasLoops || LockedInertiaBodies.Length > 0;

    /// <summary>Moving bodies with an infinite moment of inertia.</summary>
    public int[] LockedInertiaBodies { get; }

    /// <summary>Moving bodies of joints with a scalar row, whose mean rates in the drift the scalar rows ask for.</summary>
    public int[] MeanRateBodies { get; }

    /// <summary>How well its loops close: see <see cref="LoopConsistencyProbe"/>.</summary>
    public LoopConsistency Loops { get; set; }

    public bool IsInconsistent => Loops == LoopConsistency.Inconsistent;

    /// <summary>Whether a row, in the vectors' order, locks an angle.</summary>
    public bool[] IsAngular => _isAngular ??= FindAngular(Blocks, Pattern);

    /// <summary>Rows with a scalar row, of all blocks.</summary>
    public int ScalarCount { get; }

    /// <summary>Whether some rows have no closed form in lanes.</summary>
    public bool HasAssembledRows { get; }

    /// <summary>Whether the other island is of the same build, so that both can share lanes.</summary>
    public bool HasShapeOf(Island other)
    {
        if (Bodies.Length != other.Bodies.Length || MovingBodies != other.MovingBodies || Blocks.Length != other.Blocks.Length
            || Loops != other.Loops)
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

        if (LockedInertiaBodies.Length != other.LockedInertiaBodies.Length)
        {
            return false;
        }

        for (int b = 0; b < LockedInertiaBodies.Length; b++)
        {
            if (LockedInertiaBodies[b] != other.LockedInertiaBodies[b])
            {
                return false;
            }
        }

        for (int b = 0; b < MovingBodies; b++)
        {
            if (!RotationSplittings[b].Equals(other.RotationSplittings[b]))
            {
                return false;
            }
        }

        for (int n = 0; n < Blocks.Length; n++)
        {
            if (!Blocks[n].HasShapeOf(other.Blocks[n]))
            {
                return false;
            }
        }

        return true;
    }

    private static int[] FindMeanRate(RowBlock[] blocks, int movingBodies)
    {
        var rated = new SortedSet<int>();
        foreach (RowBlock block in blocks)
        {
            if (block.ScalarCount > 0)
            {
                rated.UnionWith(block.Bodies);
            }
        }

        rated.RemoveWhere(body => body >= movingBodies);
        return new List<int>(rated).ToArray();
    }

    private static int[] FindLockedInertia(int[] bodies, int movingBodies, Vector3d[] inverseInertias)
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

    private static bool[] FindAngular(RowBlock[] blocks, BlockPattern pattern)
    {
        var angular = new bool[pattern.RowCount];
        for (int n = 0; n < blocks.Length; n++)
        {
            for (int i = 0; i < blocks[n].Rows; i++)
            {
                angular[pattern.Rows[n] + i] = blocks[n].IsLockedAngle(i);
            }
        }

        return angular;
    }

    private static IEnumerable<(int A, int B)> Couplings(List<(int Node, int Side)>[] touching)
    {
        foreach (List<(int Node, int Side)> blocks in touching)
        {
            for (int i = 0; i < blocks.Count; i++)
            {
                for (int k = 0; k < i; k++)
                {
                    yield return (blocks[i].Node, blocks[k].Node);
                }
            }
        }
    }

    private static Link[] MakeLinks(List<(int Node, int Side)>[] touching, BlockPattern pattern)
    {
        var links = new List<Link>();
        for (int body = 0; body < touching.Length; body++)
        {
            List<(int Node, int Side)> blocks = touching[body];
            for (int i = 0; i < blocks.Count; i++)
            {
                for (int k = 0; k < i; k++)
                {
                    (int later, int laterSide) = blocks[i];
                    (int earlier, int earlierSide) = blocks[k];
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
