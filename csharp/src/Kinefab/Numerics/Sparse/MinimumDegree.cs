using System;
using System.Collections.Generic;
using System.Threading;

namespace Kinefab.Numerics;

/// <summary>
/// Minimum-degree elimination order of a symmetric sparse matrix of blocks: at each turn the node goes whose neighbours
/// hold the fewest rows, and its neighbours become neighbours of each other. Of several the one goes whose number has stood for
/// longest, ties by index: a chain is eaten from both ends by turns, and what follows each other in the order seldom has to wait
/// for each other's numbers, which is where a processor loses its time. A tree has no fill in it.
/// Source: Tinney and Walker 1967, scheme 2.
/// A node may wait: its own block is too weak a pivot until a neighbour has gone and added to it, so it counts as
/// <see cref="Patience"/> rows dearer until then. A few weak nodes around one neighbour so go after it; many, of which that
/// would make one dense block, still go before it.
/// </summary>
internal static class MinimumDegree
{
    /// <summary>Rows by which a waiting node's degree counts more.</summary>
    public const int Patience = 24;

    /// <summary>Orders the nodes and tells, for each, which later nodes it is coupled to when its turn comes.</summary>
    /// <param name="sizes">Rows of each node's block.</param>
    /// <param name="neighbours">For each node its neighbours, symmetric, without itself; used up by the elimination.</param>
    /// <param name="waits">Nodes that wait for a neighbour to go.</param>
    /// <param name="later">For each node its neighbours at its turn, in order of index.</param>
    /// <param name="cancellation">Ends the ordering early, with an OperationCanceledException.</param>
    /// <returns>The nodes in order of elimination.</returns>
    public static int[] Order(int[] sizes, HashSet<int>[] neighbours, bool[] waits, out int[][] later, CancellationToken cancellation = default)
    {
        int n = sizes.Length;
        var degree = new int[n];
        var isWaiting = (bool[])waits.Clone();
        var since = new int[n];
        var queue = new SortedSet<(int Degree, int Since, int Node)>();
        for (int i = 0; i < n; i++)
        {
            degree[i] = isWaiting[i] ? Patience : 0;
            foreach (int a in neighbours[i])
            {
                degree[i] += sizes[a];
            }

            queue.Add((degree[i], 0, i));
        }

        var order = new int[n];
        later = new int[n][];
        for (int turn = 0; turn < n; turn++)
        {
            cancellation.ThrowIfCancellationRequested();
            int node = queue.Min.Node;
            queue.Remove(queue.Min);
            order[turn] = node;
            var around = new int[neighbours[node].Count];
            neighbours[node].CopyTo(around);
            Array.Sort(around);
            later[node] = around;
            if (around.Length == n - turn - 1)
            {
                // All that are left become neighbours of each other: nothing is to be found out any more, only n^2 to be written.
                FinishClique(sizes, around, order, turn + 1, later);
                break;
            }

            foreach (int a in around)
            {
                queue.Remove((degree[a], since[a], a));
                neighbours[a].Remove(node);
                degree[a] -= sizes[node] + (isWaiting[a] ? Patience : 0);
                isWaiting[a] = false;
                foreach (int b in around)
                {
                    if (b != a && neighbours[a].Add(b))
                    {
                        degree[a] += sizes[b];
                    }
                }

                since[a] = turn + 1;
                queue.Add((degree[a], since[a], a));
            }

            neighbours[node].Clear();
        }

        return order;
    }

    // Among nodes that are all neighbours, the one of most rows has the least degree, whatever has gone before.
    private static void FinishClique(int[] sizes, int[] nodes, int[] order, int turn, int[][] later)
    {
        var left = new List<int>(nodes);
        var turns = (int[])nodes.Clone();
        Array.Sort(turns, (a, b) => sizes[a] != sizes[b] ? sizes[b].CompareTo(sizes[a]) : a.CompareTo(b));
        foreach (int node in turns)
        {
            left.RemoveAt(left.BinarySearch(node));
            later[node] = left.ToArray();
            order[turn++] = node;
        }
    }
}
