using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// What every body can do: the span of its twists over all motions of the mechanism. Down the tree a body's twists are its
/// parent's and what its own freedoms add, so each costs what its own joint does. Motions that are done with (free ones, and
/// those of a block that has no more bodies further down) are kept as six rows: of a QR factorisation, with the same
/// singular values. Source: Golub and Van Loan, Matrix Computations, 5.2.
/// </summary>
internal sealed class BodyTwists
{
    // Velocities are of length 1 altogether, so what is small in one body is small in itself, not only beside the rest.
    private const double LeastMotion = 1e-6;
    private const int Width = 6;

    private readonly double _leastMotion = LeastMotion;
    private readonly Linkage _linkage;
    private readonly NewtonSolver _newton;
    private readonly IndependentLinkages _parts;
    private readonly LoopMobility[] _loops;
    private readonly int[] _places;
    private readonly int[] _ends;
    private readonly int[][] _moverPlaces;
    private readonly double[][] _settled;
    private readonly List<(int Block, double[,] Twists)>[] _open;

    private BodyTwists(Linkage linkage, NewtonSolver newton, IndependentLinkages parts, LoopMobility[] loops)
    {
        _linkage = linkage;
        _newton = newton;
        _parts = parts;
        _loops = loops;
        foreach (LoopMobility loop in loops)
        {
            _leastMotion = Math.Max(_leastMotion, loop.Here.Noise);
        }

        _places = new int[linkage.BodyCount];
        _ends = new int[linkage.BodyCount];
        _settled = new double[linkage.BodyCount][];
        _open = new List<(int, double[,])>[linkage.BodyCount];
        Number(linkage.Tree);
        _moverPlaces = new int[loops.Length][];
        for (int b = 0; b < loops.Length; b++)
        {
            _moverPlaces[b] = new int[parts.Movers(b).Count];
            for (int i = 0; i < _moverPlaces[b].Length; i++)
            {
                _moverPlaces[b][i] = _places[parts.Movers(b)[i]];
            }

            Array.Sort(_moverPlaces[b]);
        }
    }

    /// <summary>Translations and rotations of each body.</summary>
    /// <param name="mechanism">Whose.</param>
    /// <param name="newton">Its freedoms' twists at the pose that is looked at.</param>
    /// <param name="parts">Its blocks.</param>
    /// <param name="loops">Their velocities at that pose.</param>
    public static List<BodyMobility> Of(Mechanism mechanism, NewtonSolver newton, IndependentLinkages parts, LoopMobility[] loops)
    {
        var twists = new BodyTwists(mechanism.Linkage, newton, parts, loops);
        var bodies = new List<BodyMobility>();
        foreach (int body in mechanism.Tree.Order)
        {
            int rank = twists.Rank(body, out int rotations);
            bodies.Add(new BodyMobility(mechanism.GameObjects[body], rank - rotations, rotations));
        }

        return bodies;
    }

    // A body's descendants are those with the places after its own up to its end.
    private void Number(KinematicTree tree)
    {
        var sizes = new int[_places.Length];
        for (int i = tree.Order.Length - 1; i >= 0; i--)
        {
            int body = tree.Order[i];
            sizes[body]++;
            if (tree.Parents[body] >= 0)
            {
                sizes[tree.Parents[body]] += sizes[body];
            }
        }

        int root = 0;
        var next = new int[_places.Length];
        foreach (int body in tree.Order)
        {
            int parent = tree.Parents[body];
            ref int place = ref (parent < 0 ? ref root : ref next[parent]);
            _places[body] = place;
            place += sizes[body];
            next[body] = _places[body] + 1;
            _ends[body] = _places[body] + sizes[body];
        }
    }

    // In order of the tree, each body once.
    private int Rank(int body, out int rotations)
    {
        int parent = _linkage.Tree.Parents[body];
        int own = _parts.BlockOf(body);
        double[] settled = parent < 0 ? new double[Width * Width] : (double[])_settled[parent].Clone();
        var open = new List<(int Block, double[,] Twists)>();
        bool isOpen = false;
        foreach ((int block, double[,] twists) in parent < 0 ? open.ToArray() : _open[parent].ToArray())
        {
            isOpen |= block == own;
            if (block == own)
            {
                open.Add((block, Moved(twists, block, body)));
            }
            else if (GoesOn(block, body))
            {
                open.Add((block, twists));
            }
            else
            {
                Append(settled, twists);
            }
        }

        if (own >= 0 && !isOpen)
        {
            open.Add((own, Moved(new double[_loops[own].FirstOrder, Width], own, body)));
        }

        if (own < 0 && _linkage.Tree.Freedoms[body] > 0)
        {
            Append(settled, Free(body));
        }

        _settled[body] = settled;
        _open[body] = open;
        double[] all = (double[])settled.Clone();
        foreach ((_, double[,] twists) in open)
        {
            Append(all, twists);
        }

        rotations = RankOf(all, Width / 2);
        return RankOf(all, 0);
    }

    private bool GoesOn(int block, int body)
    {
        int first = Array.BinarySearch(_moverPlaces[block], _places[body] + 1);
        first = first < 0 ? ~first : first;
        return first < _moverPlaces[block].Length && _moverPlaces[block][first] < _ends[body];
    }

    // The parent's twists in a block's motions and what the body's own freedoms add, one row a motion.
    private double[,] Moved(double[,] parent, int block, int body)
    {
        var twists = (double[,])parent.Clone();
        VelocitySpace space = _loops[block].Here;
        int place = _loops[block].Part.IndexOf(body);
        for (int m = 0; m < space.Freedoms; m++)
        {
            Vector3d linear = Vector3d.Zero;
            Vector3d angular = Vector3d.Zero;
            space.AddOwnTwist(place, space.Basis[m], ref linear, ref angular);
            Add(twists, m, linear, angular);
        }

        return twists;
    }

    private double[,] Free(int body)
    {
        var twists = new double[_linkage.Tree.Freedoms[body], Width];
        for (int i = 0; i < twists.GetLength(0); i++)
        {
            int column = _newton.Firsts[body] + i;
            Add(twists, i, _newton.Motion.Linear[column], _newton.Motion.Angular[column]);
        }

        return twists;
    }

    private static void Add(double[,] twists, int row, Vector3d linear, Vector3d angular)
    {
        for (int i = 0; i < 3; i++)
        {
            twists[row, i] += linear[i];
            twists[row, 3 + i] += angular[i];
        }
    }

    // Givens rotations take each new row into the upper triangle.
    private static void Append(double[] triangle, double[,] rows)
    {
        var row = new double[Width];
        for (int m = 0; m < rows.GetLength(0); m++)
        {
            for (int i = 0; i < Width; i++)
            {
                row[i] = rows[m, i];
            }

            for (int k = 0; k < Width; k++)
            {
                double a = triangle[k * Width + k];
                double length = Math.Sqrt(a * a + row[k] * row[k]);
                double c = length == 0 ? 1 : a / length;
                double s = length == 0 ? 0 : row[k] / length;
                for (int i = k; i < Width; i++)
                {
                    double above = triangle[k * Width + i];
                    triangle[k * Width + i] = c * above + s * row[i];
                    row[i] = c * row[i] - s * above;
                }
            }
        }
    }

    // Of the columns from one on. Most bodies show few motions: then the transpose of the rows that are not zero has fewer columns.
    private int RankOf(double[] triangle, int from)
    {
        Span<int> rows = stackalloc int[Width];
        int count = 0;
        for (int i = 0; i < Width; i++)
        {
            bool isZero = true;
            foreach (double entry in triangle.AsSpan(i * Width + from, Width - from))
            {
                isZero &= entry == 0;
            }

            if (!isZero)
            {
                rows[count++] = i;
            }
        }

        bool isFew = 2 * count <= Width - from;
        var matrix = isFew ? new double[Width - from, count] : new double[count, Width - from];
        for (int i = 0; i < count; i++)
        {
            for (int j = from; j < Width; j++)
            {
                double entry = triangle[rows[i] * Width + j];
                if (isFew)
                {
                    matrix[j - from, i] = entry;
                }
                else
                {
                    matrix[i, j - from] = entry;
                }
            }
        }

        return new SingularValues(matrix).Rank(_leastMotion);
    }
}
