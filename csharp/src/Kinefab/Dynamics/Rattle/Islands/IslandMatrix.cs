using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Where the numbers of an island's matrix stand: its blocks and hubs as nodes, in which order they are eliminated, and which cells the bodies
/// between them fill. Found when it is first asked for, since Unity's solver, and an island that is only looked at for loops, do without.
/// </summary>
internal sealed class IslandMatrix
{
    /// <summary>A body couples the rows of two blocks: the block (Later, Earlier) takes J_l M^-1 J_e^T over it.</summary>
    internal readonly struct BodyLink
    {
        public BodyLink(int later, int laterSide, int earlier, int earlierSide, int body, int block)
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

    /// <summary>A hub's own unknowns.</summary>
    public const int HubRows = 6;

    // n blocks that touch a body are n^2 / 2 pairs. With as many it pays to keep the body's own unknowns in the matrix.
    private const int MostEliminated = 16;

    private readonly RowBlock[] _blocks;
    private readonly int _movingBodies;
    private readonly List<(int Node, int Side)>[] _touching;
    private readonly IslandMatrix? _origin;
    private BlockPattern? _pattern;
    private BodyLink[]? _bodyLinks;
    private HubLink[]? _hubLinks;

    /// <param name="blocks">The island's joints and couplings.</param>
    /// <param name="movingBodies">Of its bodies the first, that move.</param>
    /// <param name="origin">Of the island that this is a form of, which may have the same pattern; null: of none.</param>
    public IslandMatrix(RowBlock[] blocks, int movingBodies, IslandMatrix? origin)
    {
        _blocks = blocks;
        _movingBodies = movingBodies;
        _origin = origin;
        _touching = new List<(int Node, int Side)>[movingBodies];
        for (int b = 0; b < movingBodies; b++)
        {
            _touching[b] = new List<(int Node, int Side)>();
        }

        for (int n = 0; n < blocks.Length; n++)
        {
            for (int side = 0; side < blocks[n].Bodies.Length; side++)
            {
                int body = blocks[n].Bodies[side];
                if (body < movingBodies)
                {
                    _touching[body].Add((n, side));
                }
            }
        }

        var hubs = new List<int>();
        for (int b = 0; b < movingBodies; b++)
        {
            if (_touching[b].Count > MostEliminated)
            {
                hubs.Add(b);
            }
        }

        Hubs = hubs.ToArray();
    }

    /// <summary>
    /// Moving bodies that so many blocks touch that they stay in the matrix. Instead of J M^-1 J^T over the hubs there is
    /// [., J W; W^T J^T, -1] with W W^T = M^-1, which has that as its Schur complement.
    /// </summary>
    public int[] Hubs { get; }

    /// <summary>The blocks in their order, then the hubs in theirs.</summary>
    public BlockPattern Pattern => Ordered(default);

    /// <summary>Whether the pattern has been found.</summary>
    public bool IsOrdered => _pattern != null;

    /// <summary>The couplings over bodies that are no hubs.</summary>
    public BodyLink[] BodyLinks => _bodyLinks ??= MakeBodyLinks(Pattern);

    /// <summary>Those of the hubs.</summary>
    public HubLink[] HubLinks => _hubLinks ??= MakeHubLinks(Pattern);

    /// <summary>Whether a body is one of <see cref="Hubs"/>.</summary>
    public bool IsHub(int body) => Array.BinarySearch(Hubs, body) >= 0;

    /// <summary>Makes the pattern, which takes long for wide grids, so that it can be ended early.</summary>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public void Order(CancellationToken cancellation) => Ordered(cancellation);

    /// <summary>Takes the pattern of another island, where that has been found and is the same: it has as many rows in each block, between the same bodies.</summary>
    public void TakePattern(IslandMatrix other)
    {
        if (_pattern is null && other._pattern != null && HasPatternOf(other))
        {
            _pattern = other._pattern;
        }
    }

    private BlockPattern Ordered(CancellationToken cancellation) =>
        _pattern ??= _origin != null && HasPatternOf(_origin) ? _origin.Ordered(cancellation) : MakePattern(cancellation);

    private bool HasPatternOf(IslandMatrix other)
    {
        if (_movingBodies != other._movingBodies || _blocks.Length != other._blocks.Length)
        {
            return false;
        }

        for (int n = 0; n < _blocks.Length; n++)
        {
            if (_blocks[n].Rows != other._blocks[n].Rows || !_blocks[n].Bodies.AsSpan().SequenceEqual(other._blocks[n].Bodies))
            {
                return false;
            }
        }

        return true;
    }

    private BlockPattern MakePattern(CancellationToken cancellation)
    {
        var sizes = new int[_blocks.Length + Hubs.Length];
        for (int n = 0; n < sizes.Length; n++)
        {
            sizes[n] = n < _blocks.Length ? _blocks[n].Rows : HubRows;
        }

        // What touches hubs alone has nothing on its diagonal but a compliance.
        var waits = new bool[sizes.Length];
        for (int n = 0; n < _blocks.Length && Hubs.Length > 0; n++)
        {
            waits[n] = Array.TrueForAll(_blocks[n].Bodies, body => body >= _movingBodies || IsHub(body));
        }

        return new BlockPattern(sizes, Couplings(), _blocks.Length, waits, cancellation);
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
                    yield return (_blocks.Length + hub, blocks[i].Node);
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
            int node = _blocks.Length + hub;
            foreach ((int block, int side) in _touching[Hubs[hub]])
            {
                bool isHubLater = pattern.IsBefore(block, node);
                links.Add(new HubLink(block, side, hub, isHubLater, isHubLater ? pattern.Below(node, block) : pattern.Below(block, node)));
            }
        }

        return links.ToArray();
    }

    private BodyLink[] MakeBodyLinks(BlockPattern pattern)
    {
        var links = new List<BodyLink>();
        for (int body = 0; body < _touching.Length; body++)
        {
            List<(int Node, int Side)> blocks = _touching[body];
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

                    links.Add(new BodyLink(later, laterSide, earlier, earlierSide, body, pattern.Below(later, earlier)));
                }
            }
        }

        return links.ToArray();
    }
}
