using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>All velocities that a mechanism's joints allow at one pose: the null space of its rows, block by block.</summary>
internal sealed class VelocitySpace
{
    // The rank stands in the widest gap between singular values, looked for in this window of their share of the largest.
    private const double LeastShare = 1e-7;
    private const double LargestShare = 1e-3;

    private readonly NewtonSolver _newton;
    private readonly Mechanism _mechanism;
    private readonly List<(int Block, double[] Vector)> _basis = new();

    /// <summary>Of a closed state.</summary>
    public VelocitySpace(Mechanism mechanism, NewtonSolver newton, LoopBlocks blocks, MechanismState state)
    {
        _mechanism = mechanism;
        _newton = newton;
        Blocks = blocks;
        int n = newton.Motion.Linear.Length;
        Rows = new DenseRows(newton.Firsts, n);
        newton.ClearDriven();
        newton.Motion.Start(state.Poses);
        newton.Equations.Sink = Rows;
        newton.Assemble(state);
        newton.Equations.Sink = null;
        Linear = (Vector3d[])newton.Motion.Linear.Clone();
        Angular = (Vector3d[])newton.Motion.Angular.Clone();

        Ranks = new int[blocks.Columns.Count];
        for (int b = 0; b < Ranks.Length; b++)
        {
            IReadOnlyList<int> columns = blocks.Columns[b];
            var values = new SingularValues(Rows.Matrix(columns, b, blocks.BlockOf));
            Ranks[b] = Rank(values.Values);
            for (int k = Ranks[b]; k < columns.Count; k++)
            {
                var vector = new double[n];
                for (int i = 0; i < columns.Count; i++)
                {
                    vector[columns[i]] = values.Vector(i, k);
                }

                _basis.Add((b, vector));
            }
        }

        for (int i = 0; i < n; i++)
        {
            if (blocks.BlockOf[i] < 0)
            {
                var vector = new double[n];
                vector[i] = 1;
                _basis.Add((-1, vector));
            }
        }
    }

    public LoopBlocks Blocks { get; }

    /// <summary>The rows of the loop-closing joints and couplings, in their order.</summary>
    public DenseRows Rows { get; }

    /// <summary>For each block its rank.</summary>
    public int[] Ranks { get; }

    /// <summary>Least ratio across the gap of any block.</summary>
    public double Gap { get; private set; } = double.PositiveInfinity;

    /// <summary>Orthonormal velocities, each of one block (or -1: of a freedom that no loop holds).</summary>
    public IReadOnlyList<(int Block, double[] Vector)> Basis => _basis;

    /// <summary>For each freedom the velocity at the mechanism's origin, in its lengths.</summary>
    private Vector3d[] Linear { get; }

    private Vector3d[] Angular { get; }

    /// <summary>Independent translations and rotations of a body.</summary>
    public BodyMobility Of(int body)
    {
        var twists = new double[_basis.Count, 6];
        var turns = new double[_basis.Count, 3];
        for (int v = 0; v < _basis.Count; v++)
        {
            Twist(body, _basis[v].Vector, out Vector3d linear, out Vector3d angular);
            for (int i = 0; i < 3; i++)
            {
                twists[v, i] = linear[i];
                twists[v, 3 + i] = angular[i];
                turns[v, i] = angular[i];
            }
        }

        int rotations = RankOf(turns);
        return new BodyMobility(_mechanism.GameObjects[body], RankOf(twists) - rotations, rotations);
    }

    /// <summary>A body's velocity at the mechanism's origin, in its lengths, and its angular velocity under one motion of all freedoms.</summary>
    public void Twist(int body, double[] motion, out Vector3d linear, out Vector3d angular)
    {
        linear = Vector3d.Zero;
        angular = Vector3d.Zero;
        for (int at = body; at >= 0; at = _mechanism.Tree.Parents[at])
        {
            for (int i = 0; i < _mechanism.Tree.Freedoms[at]; i++)
            {
                int column = _newton.Firsts[at] + i;
                linear += Linear[column] * motion[column];
                angular += Angular[column] * motion[column];
            }
        }
    }

    /// <summary>The block of a body's tree freedoms, of which it must have any, or -1.</summary>
    public int BlockOf(int body) => Blocks.BlockOf[_newton.Firsts[body]];

    // Velocities are of length 1 altogether, so what is small in one body is small in itself, not only beside the rest.
    private static int RankOf(double[,] matrix)
    {
        const double least = 1e-6;
        int rank = 0;
        foreach (double value in new SingularValues(matrix).Values)
        {
            rank += value > least ? 1 : 0;
        }

        return rank;
    }

    private int Rank(double[] values)
    {
        if (values.Length == 0 || values[0] == 0)
        {
            return 0;
        }

        int rank = values.Length;
        double widest = -1;
        for (int r = 1; r <= values.Length; r++)
        {
            double above = values[r - 1] / values[0];
            double below = r < values.Length ? values[r] / values[0] : 0;
            double width = Math.Log(Math.Min(above, LargestShare)) - Math.Log(Math.Max(below, LeastShare));
            if (width > widest)
            {
                widest = width;
                rank = r;
            }
        }

        if (rank < values.Length)
        {
            Gap = Math.Min(Gap, values[rank - 1] / Math.Max(values[rank], 1e-300));
        }

        return rank;
    }
}
