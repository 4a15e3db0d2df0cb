using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>All velocities that loops and couplings allow at one pose: the null space of their rows, block by block.</summary>
internal sealed class VelocitySpace
{
    // The rank stands in the widest gap between singular values, looked for in this window of their share of the largest.
    private const double LeastShare = 1e-7;
    private const double LargestShare = 1e-3;

    private const double NoiseOverGap = 10;

    private readonly int[] _firsts;
    private readonly Linkage _linkage;
    private readonly List<double[]> _basis = new();

    /// <summary>Of a closed state.</summary>
    public VelocitySpace(Linkage linkage, NewtonSolver newton, FreedomBlocks blocks, MechanismState state)
    {
        _linkage = linkage;
        _firsts = newton.Firsts;
        int n = newton.Motion.Linear.Length;
        Rows = new DenseRows(newton.Firsts, n);
        newton.ClearDriven();
        newton.Motion.Start(state.Poses);
        newton.Equations.Sink = Rows;
        newton.Assemble(state);
        newton.Equations.Sink = null;
        Linear = (Vector3d[])newton.Motion.Linear.Clone();
        Angular = (Vector3d[])newton.Motion.Angular.Clone();

        // A row holds a unit force or moment: what is far smaller beside a link's length is a rounding, or noise, were it the largest.
        double size = Math.Min(1, MechanismScale.LinkLength(linkage.Joints, state.Poses, linkage.Length) / linkage.Length);
        for (int b = 0; b < blocks.Columns.Count; b++)
        {
            IReadOnlyList<int> columns = blocks.Columns[b];
            var values = new SingularValues(Rows.Matrix(columns, b, blocks.BlockOf));
            int rank = Rank(values.Values, size);
            for (int k = rank; k < columns.Count; k++)
            {
                var vector = new double[n];
                for (int i = 0; i < columns.Count; i++)
                {
                    vector[columns[i]] = values.Vector(i, k);
                }

                _basis.Add(vector);
            }
        }
    }

    /// <summary>The rows of the loop-closing joints and couplings, in their order.</summary>
    public DenseRows Rows { get; }

    /// <summary>Least ratio across the gap of any block.</summary>
    public double Gap { get; private set; } = double.PositiveInfinity;

    /// <summary>What may be in a velocity without being in the motion, as a share: more than rounding where repeated rows do not quite repeat each other.</summary>
    public double Noise => NoiseOverGap / Gap;

    /// <summary>Orthonormal velocities, each of one block. A freedom that no loop holds has its own, which stands in none.</summary>
    public IReadOnlyList<double[]> Basis => _basis;

    /// <summary>Number of independent velocities.</summary>
    public int Freedoms => _basis.Count;

    /// <summary>A step along a mixture of all velocities, the same on every machine; zero where there are none.</summary>
    /// <param name="round">Another mixture for each.</param>
    /// <param name="length">Of its largest entry, radians or lengths.</param>
    public double[] Mixture(int round, double length)
    {
        var step = new double[Linear.Length];
        for (int k = 0; k < _basis.Count; k++)
        {
            double weight = Trigonometry.Sin(12.9898 * (k + 1) + 4.1414 * round);
            for (int i = 0; i < step.Length; i++)
            {
                step[i] += weight * _basis[k][i];
            }
        }

        double largest = 0;
        foreach (double entry in step)
        {
            largest = Math.Max(largest, Math.Abs(entry));
        }

        for (int i = 0; i < step.Length && largest > 0; i++)
        {
            step[i] *= length / largest;
        }

        return step;
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

    // size: what a row's largest singular value is where none is lost; it stands before them, so that the border may lie below them all.
    private int Rank(double[] values, double size)
    {
        double largest = values.Length == 0 ? size : Math.Max(values[0], size);
        int rank = values.Length;
        double widest = 0;
        for (int r = 0; r <= values.Length; r++)
        {
            double above = (r > 0 ? values[r - 1] : size) / largest;
            double below = (r < values.Length ? values[r] : 0) / largest;
            double width = above / Math.Max(below, LeastShare);
            if (above > LeastShare && below < LargestShare && width > widest)
            {
                widest = width;
                rank = r;
            }
        }

        if (rank < values.Length)
        {
            Gap = Math.Min(Gap, (rank > 0 ? values[rank - 1] : size) / Math.Max(values[rank], 1e-300));
        }

        return rank;
    }
}
