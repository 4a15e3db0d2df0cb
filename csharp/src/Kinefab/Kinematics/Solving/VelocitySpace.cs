using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// All velocities that loops and couplings allow at one pose: the null space of their rows, block by block. Of large blocks the rows that
/// count beyond doubt are taken out first, one by one, and only what of the others is left is decomposed.
/// </summary>
internal sealed class VelocitySpace
{
    // The rank stands in the widest gap between singular values, looked for in this window of their share of the largest.
    private const double LeastShare = 1e-7;
    private const double LargestShare = 1e-3;

    private const double NoiseOverGap = 10;

    // Share of a velocity up to which a body does not move in it.
    private const double Moves = 1e-6;

    // A gap between singular values that is wider than this share of the widest might have been the widest in other units.
    private const double AlsoWide = 0.01;

    // Up to so many freedoms a block is decomposed whole.
    private const int Few = 64;

    // Of a motion, beside the least singular value that counts: no better than rounding makes it.
    private const double Exact = 1e-14;
    private const int Refinements = 3;
    private const double RefiningDamping = 1e-12;

    private readonly int[] _firsts;
    private readonly Linkage _linkage;
    private readonly List<double[]> _basis = new();
    private readonly List<double> _kept = new();
    private readonly double _size;

    /// <summary>Of a closed state.</summary>
    public VelocitySpace(Linkage linkage, NewtonSolver newton, FreedomBlocks blocks, MechanismState state)
    {
        _linkage = linkage;
        _firsts = newton.Firsts;
        int n = newton.Motion.Linear.Length;
        newton.ClearDriven();
        newton.Motion.Start(state.Poses);
        Rows = newton.Rows(state);
        Linear = (Vector3d[])newton.Motion.Linear.Clone();
        Angular = (Vector3d[])newton.Motion.Angular.Clone();

        // A row holds a unit force or moment: what is far smaller beside a link's length is a rounding, or noise, were it the largest.
        _size = MechanismScale.LinkShare(linkage, state.Poses);
        for (int b = 0; b < blocks.Columns.Count; b++)
        {
            AddMotions(newton, blocks.Columns[b], Rows.Of(b, blocks.BlockOf), n, _size);
        }
    }

    /// <summary>The rows of the loop-closing joints and couplings, in their order.</summary>
    public PackedRows Rows { get; }

    /// <summary>Least ratio across the gap of any block.</summary>
    public double Gap { get; private set; } = double.PositiveInfinity;

    /// <summary>Greatest singular value that does not count.</summary>
    public double Dropped { get; private set; }

    /// <summary>What may be in a velocity without being in the motion, as a share: more than rounding where repeated rows do not quite repeat each other.</summary>
    public double Noise => NoiseOverGap / Gap;

    /// <summary>How many more velocities, or fewer, another gap between the singular values would leave that is about as wide.</summary>
    public int InDoubt { get; private set; }

    /// <summary>Orthonormal velocities, each of one block. A freedom that no loop holds has its own, which stands in none.</summary>
    public IReadOnlyList<double[]> Basis => _basis;

    /// <summary>Number of independent velocities.</summary>
    public int Freedoms => _basis.Count;

    /// <summary>
    /// Of a direction in a mixture, between -1 and 1, the same on every machine. As many rounds as there are directions are as many independent
    /// mixtures, and no two directions go together in all of them, as they would by a rule like sin(a direction + b round): its mixtures span two.
    /// </summary>
    /// <param name="direction">By its place.</param>
    /// <param name="round">Another mixture for each.</param>
    public static double Weight(int direction, int round) => SplitMix.Around0(((ulong)round << 32) + (ulong)direction);

    /// <summary>
    /// How many singular values that count may come from what the file is open by alone. Links in line that miss their joints by a gap close it
    /// turned, and hold the velocity that they have in line by as much.
    /// </summary>
    /// <param name="gap">In the mechanism's lengths or radians.</param>
    public int HeldBy(double gap)
    {
        double turned = Turned(gap);
        return _kept.FindAll(value => value <= turned).Count;
    }

    /// <summary>How far links in line turn that close a gap.</summary>
    /// <param name="gap">In the mechanism's lengths or radians.</param>
    public double Turned(double gap) => MechanismScale.Turned(gap, _size);

    /// <summary>A step along a mixture of all velocities, the same on every machine; zero where there are none.</summary>
    /// <param name="round">Another mixture for each.</param>
    /// <param name="length">Of its largest entry, radians or lengths.</param>
    public double[] Mixture(int round, double length)
    {
        var step = new double[Linear.Length];
        for (int k = 0; k < _basis.Count; k++)
        {
            DenseVector.Add(step, Weight(k, round), _basis[k]);
        }

        double largest = DenseVector.Largest(step);
        for (int i = 0; i < step.Length && largest > 0; i++)
        {
            step[i] *= length / largest;
        }

        return step;
    }

    /// <summary>Velocities, of length 1, that are the only ones in which some bodies do not move against what they hang on.</summary>
    public List<double[]> AtRest()
    {
        var found = new List<double[]>();
        int[] order = _linkage.Tree.Order;
        for (int first = 0; first < order.Length; first++)
        {
            List<double[]> left = _basis;
            for (int k = 0; k < order.Length; k++)
            {
                int body = order[(first + k) % order.Length];
                SingularValues own = OwnFreedoms(body, left);
                int moving = own.Rank(Moves);
                left = moving < left.Count ? Mixtures(left, own, moving) : left;
            }

            if (left.Count == 1 && !found.Exists(other => Math.Abs(DenseVector.Dot(other, left[0])) > 1 - Moves))
            {
                found.Add(left[0]);
            }
        }

        return found;
    }

    private SingularValues OwnFreedoms(int body, List<double[]> velocities)
    {
        var own = new double[_linkage.Tree.Freedoms[body], velocities.Count];
        for (int i = 0; i < own.GetLength(0); i++)
        {
            for (int m = 0; m < velocities.Count; m++)
            {
                own[i, m] = velocities[m][_firsts[body] + i];
            }
        }

        return new SingularValues(own);
    }

    /// <summary>For each freedom the velocity at the mechanism's origin, in its lengths.</summary>
    private Vector3d[] Linear { get; }

    private Vector3d[] Angular { get; }

    /// <summary>A body's velocity at the mechanism's origin, in its lengths, and its angular velocity under one motion of all freedoms.</summary>
    public void Twist(int body, double[] motion, out Vector3d linear, out Vector3d angular)
    {
        linear = Vector3d.Zero;
        angular = Vector3d.Zero;
        for (int at = body; at >= 0; at = _linkage.Tree.Parents[at])
        {
            AddOwnTwist(at, motion, ref linear, ref angular);
        }
    }

    /// <summary>Adds the part of a body's twist that its own freedoms make, against its parent's.</summary>
    public void AddOwnTwist(int body, double[] motion, ref Vector3d linear, ref Vector3d angular)
    {
        for (int i = 0; i < _linkage.Tree.Freedoms[body]; i++)
        {
            int column = _firsts[body] + i;
            linear += Linear[column] * motion[column];
            angular += Angular[column] * motion[column];
        }
    }

    /// <summary>How many singular values count.</summary>
    /// <param name="values">Falling.</param>
    /// <param name="size">
    /// What a row's largest is where none is lost; it stands before them, so that the border may lie below them all.
    /// </param>
    public static int Rank(IReadOnlyList<double> values, double size) => Rank(values, size, out _);

    private static int Rank(IReadOnlyList<double> values, double size, out int inDoubt)
    {
        double largest = values.Count == 0 ? size : Math.Max(values[0], size);
        int rank = values.Count;
        double widest = 0;
        for (int r = 0; r <= values.Count; r++)
        {
            double width = Width(r);
            if (width > widest)
            {
                widest = width;
                rank = r;
            }
        }

        inDoubt = 0;
        for (int r = 0; r <= values.Count; r++)
        {
            if (Width(r) > AlsoWide * widest)
            {
                inDoubt = Math.Max(inDoubt, Math.Abs(r - rank));
            }
        }

        return rank;

        // Of the gap before a value; 0 where the border may not lie.
        double Width(int r)
        {
            double above = (r > 0 ? values[r - 1] : size) / largest;
            double below = (r < values.Count ? values[r] : 0) / largest;
            return above > LeastShare && below < LargestShare ? above / Math.Max(below, LeastShare) : 0;
        }
    }

    private void AddMotions(NewtonSolver newton, IReadOnlyList<int> columns, List<int> rows, int freedoms, double size)
    {
        var columnOf = new Dictionary<int, int>();
        for (int i = 0; i < columns.Count; i++)
        {
            columnOf.Add(columns[i], i);
        }

        bool isLarge = columns.Count > Few;
        double least = isLarge ? LargestShare * Math.Max(size, LongestOf(rows)) : double.PositiveInfinity;
        var elimination = new RowElimination(columns.Count);
        var kept = new List<double>();
        var left = new List<(int[] Columns, double[] Row)>();
        foreach (int r in rows)
        {
            int[] places = Array.ConvertAll(Rows.Columns(r), column => columnOf[column]);
            double length = elimination.Take(places, Rows.Row(r), least);
            if (length > least)
            {
                kept.Add(length);
            }
            else
            {
                left.Add((places, Rows.Row(r)));
            }
        }

        List<double[]> motions = elimination.Basis();
        var matrix = new double[left.Count, motions.Count];
        for (int r = 0; r < left.Count; r++)
        {
            double[] along = elimination.Along(left[r].Columns, left[r].Row);
            for (int i = 0; i < along.Length; i++)
            {
                matrix[r, i] = along[i];
            }
        }

        kept.Sort((a, b) => b.CompareTo(a));
        double rest = Length(matrix);
        bool isRefined = isLarge && rest > Exact * Least(kept, size);
        if (isRefined)
        {
            var values = new SingularValues(matrix);
            int weak = Array.FindIndex(values.Values, value => value <= least);
            weak = weak < 0 ? motions.Count : weak;
            kept.AddRange(values.Values.AsSpan(0, weak).ToArray());
            motions = Mixtures(motions, values, weak).ConvertAll(motion => Spread(motion, columns, freedoms));
            matrix = Refine(newton, motions);
            rest = Length(matrix);
        }

        if (!isLarge || kept.Count == 0 || rest > LeastShare * kept[0])
        {
            var values = new SingularValues(matrix);
            kept.AddRange(values.Values);
            int rank = Rank(kept, size, out int inDoubt);
            InDoubt += inDoubt;
            rest = rank < kept.Count ? kept[rank] : 0;
            motions = Mixtures(motions, values, rank - kept.Count + motions.Count);
            kept.RemoveRange(rank, kept.Count - rank);
        }

        if (motions.Count > 0)
        {
            Gap = Math.Min(Gap, Least(kept, size) / Math.Max(rest, 1e-300));
            Dropped = Math.Max(Dropped, rest);
        }

        _kept.AddRange(kept);
        _basis.AddRange(isRefined ? motions : motions.ConvertAll(motion => Spread(motion, columns, freedoms)));
    }

    // The rows taken out may tell less well than all of them together what is left: takes out of each motion the least step that makes up
    // for what it misses the rows by. How fast each row is missed in each motion after that.
    private double[,] Refine(NewtonSolver newton, List<double[]> motions)
    {
        var matrix = new double[Rows.Count, motions.Count];
        newton.Factor(Rows, RefiningDamping);
        for (int m = 0; m < motions.Count; m++)
        {
            double[] motion = motions[m];
            for (int n = 0; n < Refinements; n++)
            {
                double[] back = newton.Answer(Rows, Rows.Times(motion));
                for (int i = 0; i < motion.Length; i++)
                {
                    motion[i] += back[i];
                }
            }

            for (int k = 0; k < m; k++)
            {
                DenseVector.RemoveAlong(motion, motions[k]);
            }

            DenseVector.Divide(motion, DenseVector.Length(motion));
            double[] rates = Rows.Times(motion);
            for (int r = 0; r < rates.Length; r++)
            {
                matrix[r, m] = rates[r];
            }
        }

        return matrix;
    }

    private static double Least(List<double> kept, double size) => kept.Count > 0 ? kept[kept.Count - 1] : size;

    private static List<double[]> Mixtures(List<double[]> motions, SingularValues values, int first)
    {
        var mixtures = new List<double[]>();
        for (int k = first; k < motions.Count; k++)
        {
            var mixture = new double[motions[0].Length];
            for (int m = 0; m < motions.Count; m++)
            {
                double share = values.Vector(m, k);
                for (int i = 0; i < mixture.Length; i++)
                {
                    mixture[i] += share * motions[m][i];
                }
            }

            mixtures.Add(mixture);
        }

        return mixtures;
    }

    private double LongestOf(List<int> rows)
    {
        double longest = 0;
        foreach (int r in rows)
        {
            longest = Math.Max(longest, DenseVector.Length(Rows.Row(r)));
        }

        return longest;
    }

    private static double Length(double[,] matrix)
    {
        double squares = 0;
        foreach (double entry in matrix)
        {
            squares += entry * entry;
        }

        return Math.Sqrt(squares);
    }

    private static double[] Spread(double[] motion, IReadOnlyList<int> columns, int freedoms)
    {
        var vector = new double[freedoms];
        for (int i = 0; i < motion.Length; i++)
        {
            vector[columns[i]] = motion[i];
        }

        return vector;
    }
}
