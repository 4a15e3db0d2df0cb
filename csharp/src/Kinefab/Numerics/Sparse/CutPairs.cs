using System;
using System.Collections.Generic;

namespace Kinefab.Numerics;

/// <summary>
/// The blocks of a graph, and the pairs of its edges without which a block falls in two. Such edges come in classes, each of which lies
/// on one circle that any two of its edges cut. Of a depth-first search each edge back to an ancestor takes a random number and each
/// tree edge the sum (XOR) of those that go round it: edges with equal numbers are a class. Source: Pritchard and Thurimella 2011.
/// </summary>
internal sealed class CutPairs
{
    private readonly (int A, int B)[] _edges;
    private readonly List<int>[] _edgesOf;
    private readonly int[] _depths;
    private readonly ulong[] _labels;

    /// <summary>Of a graph without two edges between the same nodes.</summary>
    /// <param name="nodes">How many nodes it has; node 0 is the root of what hangs together with it.</param>
    /// <param name="edges">Its edges.</param>
    public CutPairs(int nodes, (int A, int B)[] edges)
    {
        _edges = edges;
        _edgesOf = new List<int>[nodes];
        for (int node = 0; node < nodes; node++)
        {
            _edgesOf[node] = new List<int>();
        }

        for (int e = 0; e < edges.Length; e++)
        {
            _edgesOf[edges[e].A].Add(e);
            _edgesOf[edges[e].B].Add(e);
        }

        _depths = new int[nodes];
        _labels = new ulong[edges.Length];
        BlockOf = new int[edges.Length];
        ParentEdges = new int[nodes];
        RootOf = new int[nodes];
        Array.Fill(_depths, -1);
        Array.Fill(ParentEdges, -1);
        Array.Fill(BlockOf, -1);
        for (int root = 0; root < nodes; root++)
        {
            if (_depths[root] < 0)
            {
                Search(root);
            }
        }

        Classes = MakeClasses();
    }

    /// <summary>For each edge its block; -1 for one that is on no circle.</summary>
    public int[] BlockOf { get; }

    /// <summary>For each node the edge that leads to the root; -1 for a root.</summary>
    public int[] ParentEdges { get; }

    /// <summary>For each node the root of what it hangs together with.</summary>
    public int[] RootOf { get; }

    /// <summary>Edges of which any two cut a block, from the root outwards, and then back to it: between two of them lies what does not hang on the root.</summary>
    public List<List<int>> Classes { get; }

    /// <summary>The edges of a node.</summary>
    public List<int> EdgesOf(int node) => _edgesOf[node];

    /// <summary>The end of an edge that is nearer to the root along the tree.</summary>
    public int Upper(int edge) => _depths[_edges[edge].A] < _depths[_edges[edge].B] ? _edges[edge].A : _edges[edge].B;

    /// <summary>The other end.</summary>
    public int Lower(int edge) => Other(edge, Upper(edge));

    /// <summary>The end of an edge that is not this one.</summary>
    public int Other(int edge, int node) => _edges[edge].A == node ? _edges[edge].B : _edges[edge].A;

    /// <summary>Whether an edge is of the search's tree, not one back to an ancestor.</summary>
    public bool IsOfTree(int edge) => ParentEdges[Lower(edge)] == edge;

    private void Search(int root)
    {
        var low = new Dictionary<int, int>();
        var label = new Dictionary<int, ulong>();
        var open = new Stack<int>();
        var path = new Stack<(int Node, int Next)>();
        Enter(root, 0);
        while (path.Count > 0)
        {
            (int node, int next) = path.Pop();
            if (next < _edgesOf[node].Count)
            {
                path.Push((node, next + 1));
                int edge = _edgesOf[node][next];
                int other = Other(edge, node);
                if (_depths[other] < 0)
                {
                    open.Push(edge);
                    ParentEdges[other] = edge;
                    Enter(other, _depths[node] + 1);
                }
                else if (edge != ParentEdges[node] && _depths[other] < _depths[node])
                {
                    open.Push(edge);
                    _labels[edge] = SplitMix.Bits((ulong)edge);
                    label[node] ^= _labels[edge];
                    label[other] ^= _labels[edge];
                    low[node] = Math.Min(low[node], _depths[other]);
                }
            }
            else if (ParentEdges[node] >= 0)
            {
                Leave(node);
            }
        }

        void Enter(int node, int depth)
        {
            _depths[node] = depth;
            RootOf[node] = root;
            low[node] = depth;
            label[node] = 0;
            path.Push((node, 0));
        }

        void Leave(int node)
        {
            int up = ParentEdges[node];
            int parent = Other(up, node);
            _labels[up] = label[node];
            label[parent] ^= label[node];
            low[parent] = Math.Min(low[parent], low[node]);
            if (low[node] < _depths[parent])
            {
                return;
            }

            bool isCircle = open.Peek() != up;
            int member;
            do
            {
                member = open.Pop();
                BlockOf[member] = isCircle ? up : -1;
            }
            while (member != up);
        }
    }

    private List<List<int>> MakeClasses()
    {
        var byLabel = new Dictionary<ulong, List<int>>();
        var classes = new List<List<int>>();
        for (int e = 0; e < _edges.Length; e++)
        {
            if (BlockOf[e] < 0)
            {
                continue;
            }

            if (!byLabel.TryGetValue(_labels[e], out List<int>? members))
            {
                byLabel.Add(_labels[e], members = new List<int>());
            }

            members.Add(e);
        }

        foreach (List<int> members in byLabel.Values)
        {
            if (members.Count > 1)
            {
                members.Sort((a, b) => (!IsOfTree(a), _depths[Lower(a)]).CompareTo((!IsOfTree(b), _depths[Lower(b)])));
                classes.Add(members);
            }
        }

        return classes;
    }
}
