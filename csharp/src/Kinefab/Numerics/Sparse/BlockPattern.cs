using System;
using System.Collections.Generic;
using System.Threading;

namespace Kinefab.Numerics;

/// <summary>
/// Where the blocks of a symmetric block-sparse matrix and of its factor lie in one array, and the factor's order of
/// elimination. The matrix is positive definite or, with negative nodes, quasi-definite: [P, B; B^T, -N] with P and N positive
/// definite, which has a factor L D L^T in every order (Vanderbei 1995). Blocks are dense and row-major; a diagonal block uses its lower triangle; a block below it
/// couples the rows of a later node with the columns of an earlier one. Built once for a structure, then only read.
/// </summary>
internal sealed class BlockPattern
{
    /// <summary>One column of the factor: a node, and the blocks that couple it to later nodes.</summary>
    internal sealed class Column
    {
        public Column(int size, int row, int diagonal, bool isNegative, Block[] below, int[] products)
        {
            IsNegative = isNegative;
            Size = size;
            Row = row;
            Diagonal = diagonal;
            Below = below;
            Products = products;
        }

        /// <summary>Rows of the node.</summary>
        public int Size { get; }

        /// <summary>First row of the node in a vector.</summary>
        public int Row { get; }

        /// <summary>Offset of the diagonal block.</summary>
        public int Diagonal { get; }

        /// <summary>Whether its pivots are negative.</summary>
        public bool IsNegative { get; }

        /// <summary>Blocks below the diagonal, in order of elimination of their rows' nodes.</summary>
        public Block[] Below { get; }

        /// <summary>For i, then k up to i, in Below: offset of the block that takes - L_i L_k^T.</summary>
        public int[] Products { get; }
    }

    /// <summary>A block below the diagonal: its size in rows, its first row in a vector, its offset.</summary>
    internal readonly struct Block
    {
        public Block(int size, int row, int offset)
        {
            Size = size;
            Row = row;
            Offset = offset;
        }

        public int Size { get; }

        public int Row { get; }

        public int Offset { get; }
    }

    private readonly int _positive;
    private readonly int[] _turn;
    private readonly int[] _diagonal;
    private readonly Dictionary<(int Row, int Column), int> _below = new();

    /// <summary>The pattern of the given couplings and of the fill that its elimination makes.</summary>
    /// <param name="sizes">Rows of each node.</param>
    /// <param name="couplings">Pairs of nodes whose block is not zero; order and repeats do not matter.</param>
    /// <param name="cancellation">Ends the making early, with an OperationCanceledException.</param>
    public BlockPattern(int[] sizes, IEnumerable<(int A, int B)> couplings, CancellationToken cancellation = default)
        : this(sizes, couplings, sizes.Length, new bool[sizes.Length], cancellation)
    {
    }

    /// <summary>The same of a quasi-definite matrix.</summary>
    /// <param name="sizes">Rows of each node.</param>
    /// <param name="couplings">Pairs of nodes whose block is not zero; order and repeats do not matter.</param>
    /// <param name="positive">How many nodes are positive; those behind them are negative.</param>
    /// <param name="waits">Nodes that wait for a neighbour's elimination, see <see cref="MinimumDegree"/>.</param>
    /// <param name="cancellation">Ends the making early, with an OperationCanceledException.</param>
    public BlockPattern(int[] sizes, IEnumerable<(int A, int B)> couplings, int positive, bool[] waits, CancellationToken cancellation = default)
    {
        int n = sizes.Length;
        _positive = positive;
        var neighbours = new HashSet<int>[n];
        for (int i = 0; i < n; i++)
        {
            neighbours[i] = new HashSet<int>();
        }

        foreach ((int a, int b) in couplings)
        {
            cancellation.ThrowIfCancellationRequested();
            if (a != b)
            {
                neighbours[a].Add(b);
                neighbours[b].Add(a);
            }
        }

        int[] order = MinimumDegree.Order(sizes, neighbours, waits, out int[][] later, cancellation);
        _turn = new int[n];
        for (int turn = 0; turn < n; turn++)
        {
            _turn[order[turn]] = turn;
        }

        Rows = new int[n];
        for (int i = 0; i < n; i++)
        {
            Rows[i] = RowCount;
            RowCount += sizes[i];
        }

        _diagonal = new int[n];
        foreach (int node in order)
        {
            cancellation.ThrowIfCancellationRequested();
            _diagonal[node] = Length;
            Length += sizes[node] * sizes[node];
            Array.Sort(later[node], (a, b) => _turn[a].CompareTo(_turn[b]));
            foreach (int i in later[node])
            {
                _below[(i, node)] = Length;
                Length += sizes[i] * sizes[node];
            }
        }

        Columns = new Column[n];
        for (int turn = 0; turn < n; turn++)
        {
            cancellation.ThrowIfCancellationRequested();
            Columns[turn] = MakeColumn(order[turn], later[order[turn]], sizes);
        }
    }

    /// <summary>Columns in order of elimination.</summary>
    public Column[] Columns { get; }

    /// <summary>First row of each node in a vector.</summary>
    public int[] Rows { get; }

    /// <summary>Rows of all nodes.</summary>
    public int RowCount { get; }

    /// <summary>Numbers in all blocks.</summary>
    public int Length { get; }

    /// <summary>Whether the first node is eliminated before the second.</summary>
    public bool IsBefore(int first, int second) => _turn[first] < _turn[second];

    /// <summary>Offset of a node's diagonal block.</summary>
    public int Diagonal(int node) => _diagonal[node];

    /// <summary>Offset of the block between two coupled nodes; its rows belong to the one eliminated later.</summary>
    public int Below(int later, int earlier) => _below[(later, earlier)];

    private Column MakeColumn(int node, int[] later, int[] sizes)
    {
        var below = new Block[later.Length];
        var products = new int[later.Length * (later.Length + 1) / 2];
        int next = 0;
        for (int i = 0; i < later.Length; i++)
        {
            below[i] = new Block(sizes[later[i]], Rows[later[i]], _below[(later[i], node)]);
            for (int k = 0; k <= i; k++)
            {
                products[next++] = i == k ? _diagonal[later[i]] : _below[(later[i], later[k])];
            }
        }

        return new Column(sizes[node], Rows[node], _diagonal[node], node >= _positive, below, products);
    }
}
