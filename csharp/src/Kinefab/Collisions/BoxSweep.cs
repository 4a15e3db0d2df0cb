using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;

namespace Kinefab.Collisions;

/// <summary>Pairs of shapes whose boxes meet along X, found by a walk along it.</summary>
internal static class BoxSweep
{
    /// <summary>Each such pair, but for those of one group, which are not even looked at where nothing stands between them.</summary>
    /// <param name="shapes">In any order.</param>
    /// <param name="groups">Of each shape, its group.</param>
    /// <param name="cancellation">Ends it early.</param>
    /// <returns>Pairs of indices, in the walk's order.</returns>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public static IEnumerable<(int First, int Second)> Pairs(IReadOnlyList<ConvexShape> shapes, int[] groups, CancellationToken cancellation)
    {
        int[] order = Enumerable.Range(0, groups.Length).OrderBy(i => shapes[i].Low.X).ToArray();

        // Where the next shape of another group stands.
        var next = new int[order.Length];
        for (int i = order.Length - 1; i >= 0; i--)
            next[i] = i + 1 < order.Length && groups[order[i + 1]] == groups[order[i]] ? next[i + 1] : i + 1;
        for (int i = 0; i < order.Length; i++)
        {
            cancellation.ThrowIfCancellationRequested();
            double end = shapes[order[i]].High.X;
            int k = i + 1;
            while (k < order.Length && shapes[order[k]].Low.X <= end)
            {
                if (groups[order[k]] == groups[order[i]])
                {
                    k = next[k];
                    continue;
                }

                cancellation.ThrowIfCancellationRequested();
                yield return (order[i], order[k++]);
            }
        }
    }
}
