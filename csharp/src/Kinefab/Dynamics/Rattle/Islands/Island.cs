using System;
using System.Collections.Generic;
using System.Threading;
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

    /// <summary>A hub's part of the rows of a block: 6 numbers a row, at Block in the matrix, where the hub's rows come first or the block's.</summary>
    internal readonly struct HubLink
    {
        public HubLink(int node, int side, int hub, bool isHubLater, int block)
        {
            Node = node;
            Side = side;
            Hub = hub;
            IsHubLater = isHubLater;
            Block = block;
        }

        public readonly int Node;
        public readonly int Side;

        /// <summary>Index in <see cref="Hubs"/>.</summary>
        public readonly int Hub;

        /// <summary>Whether the block's rows are the hub's and its columns the row block's; else the other way round.</summary>
        public readonly bool IsHubLater;
        public readonly int Block;
    }

    // n blocks that touch a body are n^2 / 2 pairs. With as many it pays to keep the body's own six unknowns in the matrix.
    private const int MostEliminated = 16;
    private const int HubRows = 6;

    // The pattern is built when it is first asked for, since Unity's solver, and an island that is only looked at for loops, do without.
    private readonly double[] _inverseMasses;
    private readonly Vector3d[] _inverseInertias;
    private readonly int[] _sizes;
    private readonly List<(int Node, int Side)>[] _touching;
    private readonly Island? _origin;
    private BlockPattern? _pattern;
    private Link[]? _links;
    private HubLink[]? _hubLinks;
    private bool[]? _isAngular;

    /// <param name="bodies">Index in the mechanism (or Joint.World) of each body, the moving ones first.</param>
    /// <param name="movingBodies">How many move.</param>
    /// <param name="blocks">Joints and couplings, their bodies as in the first list.</param>
    /// <param name="all">The mechanism's bodies.</param>
    public Island(int[] bodies, int movingBodies, RowBlock[] blocks, Bodies all)
        : this(
            bodies,
            movingBodies,
            blocks,
            Array.ConvertAll(bodies.AsSpan(0, movingBodies).ToArray(), body => all.InverseMasses[body]),
            Array.ConvertAll(bodies.AsSpan(0, movingBodies).ToArray(), body => all.InverseInertias[body]),
            null)
    {
    }

    // The origin is the island that this is a form of.
    private Island(int[] bodies, int movingBodies, RowBlock[] blocks, double[] inverseMasses, Vector3d[] inverseInertias, Island? origin)
    {
        _origin = origin;
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
            RowCount += sizes[n];
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

        HasJointLoops = Array.FindAll(blocks, block => block.Joint != null).Length >= LeastWithLoop;
        HasKinematic = Array.IndexOf(IsStatic, false, movingBodies) >= 0;
        _inverseMasses = inverseMasses;
        _inverseInertias = inverseInertias;
        RotationSplittings = new RotationSplitting[movingBodies];
        for (int b = 0; b < movingBodies; b++)
        {
            RotationSplittings[b] = new RotationSplitting(inverseInertias[b]);
        }

        LockedInertiaBodies = FindLockedInertia(inverseInertias);
        MeanRateBodies = FindMeanRate(blocks, movingBodies);
        _sizes = sizes;
        _touching = touching;
        var hubs = new List<int>();
        for (int b = 0; b < movingBodies; b++)
        {
            if (touching[b].Count > MostEliminated)
            {
                hubs.Add(b);
            }
        }

        Hubs = hubs.ToArray();
    }

    /// <summary>Index in the mechanism (or Joint.World) of each of the island's bodies, the moving ones first.</summary>
    public int[] Bodies { get; }

    public int MovingBodies { get; }

    /// <summary>Whether a body is the world; the other fixed ones are kinematic.</summary>
    public bool[] IsStatic { get; }

    /// <summary>How each moving body's rotation is split.</summary>
    public RotationSplitting[] RotationSplittings { get; }

    public RowBlock[] Blocks { get; }

    /// <summary>Rows of all blocks.</summary>
    public int RowCount { get; }

    /// <summary>
    /// Moving bodies that so many blocks touch that they stay in the matrix. Instead of J M^-1 J^T over the hubs there is
    /// [., J W; W^T J^T, -1] with W W^T = M^-1, which has that as its Schur complement.
    /// </summary>
    public int[] Hubs { get; }

    public bool IsHub(int body) => Hubs.Length > 0 && Array.BinarySearch(Hubs, body) >= 0;

    /// <summary>The blocks in their order, then the hubs in theirs.</summary>
    public BlockPattern Pattern => Ordered(default);

    /// <summary>Whether the pattern has been found.</summary>
    public bool IsOrdered => _pattern != null;

    /// <summary>The couplings over bodies that are no hubs.</summary>
    public Link[] Links => _links ??= MakeLinks(_touching, Pattern);

    public HubLink[] HubLinks => _hubLinks ??= MakeHubLinks(Pattern);

    /// <summary>Whether a body of theirs moves as it is told.</summary>
    public bool HasKinematic { get; }

    /// <summary>Whether nothing holds it from outside, so that its momentum is its own.</summary>
    public bool IsFloating => Bodies.Length == MovingBodies && LockedInertiaBodies.Length == 0;

    // As many as hang up the bodies, and one.
    private int LeastWithLoop => MovingBodies + (Bodies.Length > MovingBodies ? 1 : 0);

    /// <summary>Whether there are more joints and couplings than it takes to hang up the bodies, all that does not move being one.</summary>
    public bool HasLoops => Blocks.Length >= LeastWithLoop;

    /// <summary>The same of joints alone: whether axes may contradict each other round a loop.</summary>
    public bool HasJointLoops { get; }

    /// <summary>Whether rows may repeat each other or ask for a turn that a body does not make: by loops or by infinite moments.</summary>
    public bool IsRedundant => HasLoops || LockedInertiaBodies.Length > 0;

    /// <summary>Moving bodies with an infinite moment of inertia.</summary>
    public int[] LockedInertiaBodies { get; }

    /// <summary>Moving bodies of joints with scalar rows, whose mean rates in the drift the scalar rows ask for.</summary>
    public int[] MeanRateBodies { get; }

    /// <summary>How well its loops close: see <see cref="LoopConsistencyProbe"/>.</summary>
    public LoopConsistency Loops { get; set; }

    public bool IsInconsistent => Loops == LoopConsistency.Inconsistent;

    /// <summary>Whether a row, in the vectors' order, locks an angle.</summary>
    public bool[] IsAngular => _isAngular ??= FindAngular();

    /// <summary>Scalar rows of all blocks.</summary>
    public int ScalarCount { get; }

    /// <summary>Whether some rows have no closed form in lanes.</summary>
    public bool HasAssembledRows { get; }

    /// <summary>
    /// The same as it is stepped in lanes, while none of its limits is reached or while hinges rest on them. Itself, where it has no rows that are not
    /// in closed form; null, where it has others than those that have one there.
    /// </summary>
    /// <param name="holdsLimits">Whether hinges with limits have a row for the end that they rest on.</param>
    public Island? InLanes(bool holdsLimits)
    {
        if (!HasAssembledRows)
        {
            return this;
        }

        RowBlock[] plain = Array.ConvertAll(Blocks, block => block.InLanes(Blocks, holdsLimits));
        return ((IsInconsistent || Hubs.Length > 0) && Array.Exists(plain, block => block.HasAxisRow)) || Array.Exists(plain, block => block.IsAssembled || block.Rows == 0) ? null : new Island(Bodies, MovingBodies, plain, _inverseMasses, _inverseInertias, this) { Loops = Loops };
    }

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

    /// <summary>Whether the other one holds the same bodies, of the same masses, by the same joints with the same rows: what was kept of it still holds.</summary>
    public bool IsSameAs(Island other)
    {
        bool isSame = Loops == other.Loops && Blocks.Length == other.Blocks.Length && Bodies.AsSpan().SequenceEqual(other.Bodies) && MovingBodies == other.MovingBodies
            && _inverseMasses.AsSpan().SequenceEqual(other._inverseMasses) && _inverseInertias.AsSpan().SequenceEqual(other._inverseInertias);
        for (int n = 0; n < Blocks.Length && isSame; n++)
        {
            isSame = Blocks[n].IsSameAs(other.Blocks[n]);
        }

        return isSame;
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

    private static int[] FindLockedInertia(Vector3d[] inverseInertias)
    {
        var locked = new List<int>();
        for (int b = 0; b < inverseInertias.Length; b++)
        {
            Vector3d inverse = inverseInertias[b];
            if (inverse.X == 0 || inverse.Y == 0 || inverse.Z == 0)
            {
                locked.Add(b);
            }
        }

        return locked.ToArray();
    }

    private bool[] FindAngular()
    {
        var angular = new bool[RowCount];
        int row = 0;
        foreach (RowBlock block in Blocks)
        {
            for (int i = 0; i < block.Rows; i++)
            {
                angular[row++] = block.IsLockedAngle(i);
            }
        }

        return angular;
    }

    /// <summary>Makes the pattern, which takes long for wide grids, so that it can be ended early.</summary>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public void Order(CancellationToken cancellation) => Ordered(cancellation);

    /// <summary>Takes the pattern of another island, where that has been found and is the same: it has as many rows in each block, between the same bodies.</summary>
    public void TakePattern(Island other)
    {
        if (_pattern is null && other._pattern != null && HasPatternOf(other))
        {
            _pattern = other._pattern;
        }
    }

    private BlockPattern Ordered(CancellationToken cancellation) =>
        _pattern ??= _origin != null && HasPatternOf(_origin) ? _origin.Ordered(cancellation) : MakePattern(cancellation);

    private bool HasPatternOf(Island other)
    {
        if (MovingBodies != other.MovingBodies || Blocks.Length != other.Blocks.Length)
        {
            return false;
        }

        for (int n = 0; n < Blocks.Length; n++)
        {
            if (Blocks[n].Rows != other.Blocks[n].Rows || !Blocks[n].Bodies.AsSpan().SequenceEqual(other.Blocks[n].Bodies))
            {
                return false;
            }
        }

        return true;
    }

    private BlockPattern MakePattern(CancellationToken cancellation)
    {
        var sizes = new int[Blocks.Length + Hubs.Length];
        _sizes.CopyTo(sizes, 0);
        for (int hub = Blocks.Length; hub < sizes.Length; hub++)
        {
            sizes[hub] = HubRows;
        }

        // What touches hubs alone has nothing on its diagonal but a compliance.
        var waits = new bool[sizes.Length];
        for (int n = 0; n < Blocks.Length && Hubs.Length > 0; n++)
        {
            waits[n] = Array.TrueForAll(Blocks[n].Bodies, body => body >= MovingBodies || IsHub(body));
        }

        return new BlockPattern(sizes, Couplings(), Blocks.Length, waits, cancellation);
    }

    private IEnumerable<(int A, int B)> Couplings()
    {
        for (int body = 0; body < _touching.Length; body++)
        {
            List<(int Node, int Side)> blocks = _touching[body];
            int hub = Array.BinarySearch(Hubs, body);
            for (int i = 0; i < blocks.Count; i++)
            {
                if (hub >= 0)
                {
                    yield return (Blocks.Length + hub, blocks[i].Node);
                }

                for (int k = 0; k < i && hub < 0; k++)
                {
                    yield return (blocks[i].Node, blocks[k].Node);
                }
            }
        }
    }

    private HubLink[] MakeHubLinks(BlockPattern pattern)
    {
        var links = new List<HubLink>();
        for (int hub = 0; hub < Hubs.Length; hub++)
        {
            int node = Blocks.Length + hub;
            foreach ((int block, int side) in _touching[Hubs[hub]])
            {
                bool isHubLater = pattern.IsBefore(block, node);
                links.Add(new HubLink(block, side, hub, isHubLater, isHubLater ? pattern.Below(node, block) : pattern.Below(block, node)));
            }
        }

        return links.ToArray();
    }

    private Link[] MakeLinks(List<(int Node, int Side)>[] touching, BlockPattern pattern)
    {
        var links = new List<Link>();
        for (int body = 0; body < touching.Length; body++)
        {
            List<(int Node, int Side)> blocks = touching[body];
            for (int i = 0; i < blocks.Count && !IsHub(body); i++)
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
