using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>Neighbouring bodies of one closed loop that move as one and alone: the joints at their two ends share a twist.</summary>
internal static class SingleLoop
{
    // Share of a joint's largest singular value below which it has no further freedom in any motion.
    private const double Moving = 1e-7;

    // How far the cosine between two joints' twists, squared, may be from 1.
    private const double Shared = 1e-12;

    // Length of a motion beside those already found from which it is another one.
    private const double New = 1e-6;

    /// <summary>
    /// Neighbours that move as one and alone, and in how many ways; none where a coupling joins joints of the loop, whose motions
    /// are then not their own.
    /// </summary>
    /// <param name="motions">Velocities of the loop that keep it closed.</param>
    /// <param name="neighbours">Bodies that joints connect with each, the one at rest included.</param>
    public static List<(List<int> Groups, int Count)> TurningAlone(LoopMotions motions, Dictionary<int, SortedSet<int>> neighbours)
    {
        var found = new List<(List<int> Groups, int Count)>();
        if (motions.IsCoupled)
        {
            return found;
        }

        List<int> ring = Ring(motions.Groups, neighbours);
        List<double[]>[] joints = JointTwists(ring, motions);
        double shared = Math.Max(Shared, motions.Noise * motions.Noise);
        var known = new List<double[]>();
        for (int size = 1; size < ring.Count; size++)
        {
            for (int first = 0; first + size <= ring.Count; first++)
            {
                int count = 0;
                foreach (double[] twist in Common(joints[first], joints[first + size], shared))
                {
                    var motion = new double[6 * ring.Count];
                    for (int i = 0; i < 6 * size; i++)
                    {
                        motion[6 * first + i] = twist[i % 6] / Math.Sqrt(size);
                    }

                    count += IsNew(motion, known) ? 1 : 0; // a ram's spin is that of its tube and of its piston, if these turn
                }

                if (count > 0)
                {
                    found.Add((ring.GetRange(first, size), count));
                }
            }
        }

        return found;
    }

    /// <summary>Where a loop begins and ends, beside which two of its bodies stand; null where it is none.</summary>
    /// <param name="groups">The loop's own bodies.</param>
    /// <param name="neighbours">Bodies that joints connect with each, the one at rest included.</param>
    public static int? Root(List<int> groups, Dictionary<int, SortedSet<int>> neighbours)
    {
        var inside = new HashSet<int>(groups);
        var seen = new HashSet<int>();
        foreach (int group in groups)
        {
            foreach (int other in neighbours[group])
            {
                if (!inside.Contains(other) && !seen.Add(other))
                {
                    return other;
                }
            }
        }

        return null;
    }

    // The bodies in the order in which their loop joins them, from the one at rest and back to it.
    private static List<int> Ring(List<int> groups, Dictionary<int, SortedSet<int>> neighbours)
    {
        var inside = new HashSet<int>(groups);
        var ring = new List<int>();
        int? root = Root(groups, neighbours);
        foreach (int group in groups)
        {
            if (root is int beside && neighbours[group].Contains(beside))
            {
                ring.Add(group);
                break;
            }
        }

        while (ring.Count > 0 && inside.Remove(ring[ring.Count - 1]))
        {
            foreach (int next in neighbours[ring[ring.Count - 1]])
            {
                if (inside.Contains(next))
                {
                    ring.Add(next);
                    break;
                }
            }
        }

        return ring;
    }

    // For each joint of the loop an orthonormal basis of its twists in the motions, the joint before the first body first.
    private static List<double[]>[] JointTwists(List<int> ring, LoopMotions motions)
    {
        var joints = new List<double[]>[ring.Count + 1];
        var before = new double[motions.Count, 6];
        for (int k = 0; k <= ring.Count; k++)
        {
            var after = new double[motions.Count, 6];
            var relative = new double[motions.Count, 6];
            for (int m = 0; m < motions.Count; m++)
            {
                if (k < ring.Count)
                {
                    motions.Twist(ring[k], m, out Vector3d linear, out Vector3d angular);
                    for (int i = 0; i < 3; i++)
                    {
                        after[m, i] = linear[i];
                        after[m, 3 + i] = angular[i];
                    }
                }

                for (int i = 0; i < 6; i++)
                {
                    relative[m, i] = after[m, i] - before[m, i];
                }
            }

            joints[k] = Span(relative, Math.Max(Moving, motions.Noise));
            before = after;
        }

        return joints;
    }

    private static List<double[]> Span(double[,] rows, double moving)
    {
        var values = new SingularValues(rows);
        var span = new List<double[]>();
        for (int k = 0; k < 6 && values.Values[k] > moving * values.Values[0]; k++)
        {
            var vector = new double[6];
            for (int i = 0; i < 6; i++)
            {
                vector[i] = values.Vector(i, k);
            }

            span.Add(vector);
        }

        return span;
    }

    // Unit twists that lie in both spans.
    private static IEnumerable<double[]> Common(List<double[]> a, List<double[]> b, double shared)
    {
        var cosines = new double[b.Count, a.Count];
        for (int i = 0; i < b.Count; i++)
        {
            for (int j = 0; j < a.Count; j++)
            {
                cosines[i, j] = DenseVector.Dot(b[i], a[j]);
            }
        }

        var values = new SingularValues(cosines);
        for (int k = 0; k < a.Count && values.Values[k] * values.Values[k] > 1 - shared; k++)
        {
            var twist = new double[6];
            for (int j = 0; j < a.Count; j++)
            {
                for (int i = 0; i < 6; i++)
                {
                    twist[i] += a[j][i] * values.Vector(j, k);
                }
            }

            yield return twist;
        }
    }

    private static bool IsNew(double[] motion, List<double[]> known)
    {
        foreach (double[] other in known)
        {
            DenseVector.RemoveAlong(motion, other);
        }

        double rest = DenseVector.Length(motion);
        if (rest <= New)
        {
            return false;
        }

        DenseVector.Divide(motion, rest);
        known.Add(motion);
        return true;
    }
}
