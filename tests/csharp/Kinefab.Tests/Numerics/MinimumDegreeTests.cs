using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Numerics;

/// <summary>The order of elimination against the rule carried out word for word.</summary>
internal sealed class MinimumDegreeTests
{
    private static readonly int[] FromBothEnds = [0, 5, 1, 4, 2, 3];

    [Test]
    public void Order_RandomGraphs_IsTheRulesOrder([Range(0, 199)] int seed)
    {
        var random = new Random(seed);
        int n = random.Next(1, 25);
        double density = random.NextDouble();
        int[] sizes = Enumerable.Range(0, n).Select(_ => random.Next(0, 7)).ToArray();
        bool[] waits = Enumerable.Range(0, n).Select(_ => seed % 2 == 1 && random.Next(4) == 0).ToArray();
        HashSet<int>[] graph = Enumerable.Range(0, n).Select(_ => new HashSet<int>()).ToArray();
        for (int a = 0; a < n; a++)
        {
            for (int b = 0; b < a; b++)
            {
                if (random.NextDouble() < density)
                {
                    graph[a].Add(b);
                    graph[b].Add(a);
                }
            }
        }

        (int[] order, int[][] later) = ByTheRule(sizes, graph, waits);
        Assert.That(MinimumDegree.Order(sizes, graph, waits, out int[][] found), Is.EqualTo(order));
        Assert.That(found, Is.EqualTo(later));
    }

    [Test]
    public void Order_Chain_GoesFromBothEnds()
    {
        HashSet<int>[] chain = Enumerable.Range(0, 6).Select(i => new HashSet<int>(new[] { i - 1, i + 1 }.Where(k => k is >= 0 and < 6))).ToArray();
        Assert.That(MinimumDegree.Order([5, 5, 5, 5, 5, 5], chain, new bool[6], out _), Is.EqualTo(FromBothEnds));
    }

    private static (int[] Order, int[][] Later) ByTheRule(int[] sizes, HashSet<int>[] graph, bool[] waits)
    {
        HashSet<int>[] left = graph.Select(around => new HashSet<int>(around)).ToArray();
        var waiting = new HashSet<int>(Enumerable.Range(0, sizes.Length).Where(i => waits[i]));
        var nodes = new SortedSet<int>(Enumerable.Range(0, sizes.Length));
        var order = new List<int>();
        var since = new int[sizes.Length];
        var later = new int[sizes.Length][];
        while (nodes.Count > 0)
        {
            int node = nodes.OrderBy(a => left[a].Sum(b => sizes[b]) + (waiting.Contains(a) ? MinimumDegree.Patience : 0)).ThenBy(a => since[a]).ThenBy(a => a).First();
            nodes.Remove(node);
            order.Add(node);
            later[node] = left[node].Order().ToArray();
            waiting.ExceptWith(later[node]);
            foreach (int a in later[node])
            {
                left[a].UnionWith(later[node]);
                left[a].ExceptWith([a, node]);
                since[a] = order.Count;
            }
        }

        return (order.ToArray(), later);
    }
}
