using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Numerics;

/// <summary>Blocks and cut pairs of random graphs, against taking the edges away.</summary>
public class CutPairsTests
{
    [Test]
    public void Classes_OfRandomGraphs_AreThePairsThatCut([Range(0, 99)] int seed)
    {
        var draw = new Random(seed);
        int nodes = draw.Next(2, 13);
        var edges = new HashSet<(int, int)>();
        for (int i = draw.Next(1, nodes + 8); i > 0; i--)
        {
            int a = draw.Next(nodes), b = draw.Next(nodes);
            if (a != b)
            {
                edges.Add((Math.Min(a, b), Math.Max(a, b)));
            }
        }

        (int A, int B)[] all = edges.ToArray();
        var found = new CutPairs(nodes, all);
        int whole = Parts(nodes, all);
        bool[] isBridge = Enumerable.Range(0, all.Length).Select(e => Parts(nodes, Without(all, e)) > whole).ToArray();
        Assert.That(found.BlockOf.Select(block => block < 0), Is.EqualTo(isBridge));
        var told = new HashSet<(int, int)>();
        foreach (List<int> members in found.Classes)
        {
            told.UnionWith(from e in members from f in members where e < f select (e, f));
        }

        IEnumerable<(int, int)> cut =
            from e in Enumerable.Range(0, all.Length)
            from f in Enumerable.Range(e + 1, all.Length - e - 1)
            where !isBridge[e] && !isBridge[f] && Parts(nodes, Without(all, e, f)) > whole
            select (e, f);
        Assert.That(told, Is.EquivalentTo(cut));
    }

    private static IEnumerable<(int A, int B)> Without((int A, int B)[] edges, params int[] left) =>
        edges.Where((_, e) => !left.Contains(e));

    private static int Parts(int nodes, IEnumerable<(int A, int B)> edges)
    {
        var sets = new DisjointSets(nodes);
        foreach ((int a, int b) in edges)
        {
            sets.Join(a, b);
        }

        return Enumerable.Range(0, nodes).Select(sets.Find).Distinct().Count();
    }
}
