using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// The damped least-squares step dy = -(J^T J + mu I)^-1 J^T C over the tree's freedoms, block-sparse: one node a body.
/// Damping makes it the step of (nearly) least norm where rows are redundant or freedoms are left over.
/// Source: Levenberg 1944, Marquardt 1963.
/// </summary>
internal sealed class NormalEquations
{
    // With fewer no matrix is large.
    private const int LeastFreedoms = 12;

    private readonly BlockPattern _pattern;
    private readonly int[] _freedoms;
    private readonly Dictionary<RowPath, int[]> _blocks = new();
    private readonly double[] _matrix;
    private readonly double[] _step;
    private readonly double[] _pivots;
    private readonly DualEquations _dual;
    private bool _isDual;
    private double _largest;

    /// <summary>Reserves the blocks that rows along the given paths need.</summary>
    public NormalEquations(KinematicTree tree, IReadOnlyList<RowPath> paths, CancellationToken cancellation = default)
    {
        _freedoms = tree.Freedoms;
        var node = new int[_freedoms.Length];
        var sizes = new List<int>();
        for (int body = 0; body < node.Length; body++)
        {
            node[body] = -1;
        }

        foreach (int body in tree.Order)
        {
            if (_freedoms[body] > 0)
            {
                node[body] = sizes.Count;
                sizes.Add(_freedoms[body]);
            }
        }

        _pattern = new BlockPattern(sizes.ToArray(), Couplings(paths, node), cancellation);
        _matrix = new double[_pattern.Length];
        _step = new double[_pattern.RowCount];
        _pivots = new double[_pattern.RowCount];
        Firsts = new int[_freedoms.Length];
        foreach (int body in tree.Order)
        {
            Firsts[body] = node[body] < 0 ? 0 : _pattern.Rows[node[body]];
        }

        _dual = new DualEquations(Firsts, _step.Length);
        foreach (RowPath path in paths)
        {
            cancellation.ThrowIfCancellationRequested();
            if (!_blocks.ContainsKey(path))
            {
                _blocks.Add(path, BlocksOf(path, node));
            }
        }
    }

    /// <summary>For each body the place of its first freedom in a step.</summary>
    public int[] Firsts { get; }

    /// <summary>The step, once it is solved for.</summary>
    public double[] Step => _step;

    /// <summary>Pivots of the last Solve; in the same order for the same rows.</summary>
    public ReadOnlySpan<double> Pivots => _isDual ? _dual.Pivots : _pivots;

    /// <summary>Freedoms that the last Solve had no row for, beside those whose pivots vanish.</summary>
    public int Spare => _isDual ? _step.Length - _dual.Count : 0;

    /// <summary>Forgets all rows.</summary>
    public void Clear()
    {
        _dual.Clear();
        _isDual = true;
        if (_step.Length < LeastFreedoms)
        {
            LeaveDual();
        }
    }

    /// <summary>Adds one row of J, packed along its path, and its C.</summary>
    public void Add(RowPath path, ReadOnlySpan<double> row, double c)
    {
        if (_isDual && _dual.Count == DualEquations.MaxRows)
        {
            LeaveDual();
        }

        if (_isDual)
        {
            _dual.Add(path, row, c);
        }
        else
        {
            AddToMatrix(path, row, c);
        }
    }

    private void LeaveDual()
    {
        _isDual = false;
        Array.Clear(_matrix, 0, _matrix.Length);
        Array.Clear(_step, 0, _step.Length);
        for (int i = 0; i < _dual.Count; i++)
        {
            ReadOnlySpan<double> row = _dual.Row(i, out RowPath path, out double c);
            AddToMatrix(path, row, c);
        }
    }

    private void AddToMatrix(RowPath path, ReadOnlySpan<double> row, double c)
    {
        int[] blocks = _blocks[path];
        int[] bodies = path.Bodies;
        if (path.Width == bodies.Length)
        {
            AddSingles(blocks, bodies, row, c);
            return;
        }

        int block = 0;
        for (int k = 0; k < bodies.Length; k++)
        {
            int size = path.Starts[k + 1] - path.Starts[k];
            ReadOnlySpan<double> rk = row.Slice(path.Starts[k], size);
            int first = Firsts[bodies[k]];
            for (int i = 0; i < size; i++)
            {
                _step[first + i] += rk[i] * c;
            }

            for (int l = 0; l < k; l++)
            {
                ReadOnlySpan<double> rl = row.Slice(path.Starts[l], path.Starts[l + 1] - path.Starts[l]);
                int offset = blocks[block++];
                if (offset >= 0)
                {
                    AddProduct(offset, rk, rl);
                }
                else
                {
                    AddProduct(~offset, rl, rk);
                }
            }

            int diagonal = blocks[block++];
            for (int i = 0; i < size; i++)
            {
                for (int j = 0; j <= i; j++)
                {
                    _matrix[diagonal + i * size + j] += rk[i] * rk[j];
                }
            }
        }
    }

    // Bodies of one freedom each, as of hinges: blocks are single numbers.
    private void AddSingles(int[] blocks, int[] bodies, ReadOnlySpan<double> row, double c)
    {
        int block = 0;
        for (int k = 0; k < bodies.Length; k++)
        {
            double entry = row[k];
            _step[Firsts[bodies[k]]] += entry * c;
            foreach (double other in row[..k])
            {
                int offset = blocks[block++];
                _matrix[offset >= 0 ? offset : ~offset] += entry * other;
            }

            _matrix[blocks[block++]] += entry * entry;
        }
    }

    /// <summary>Adds a symmetric matrix over a path's freedoms, full and row by row: second derivatives that J^T J leaves out.</summary>
    public void AddMatrix(RowPath path, ReadOnlySpan<double> matrix)
    {
        if (_isDual)
        {
            LeaveDual();
        }

        int[] blocks = _blocks[path];
        int width = path.Width;
        int block = 0;
        for (int k = 0; k < path.Bodies.Length; k++)
        {
            for (int l = 0; l <= k; l++)
            {
                int offset = blocks[block++];
                int rows = offset >= 0 ? k : l;
                int columns = offset >= 0 ? l : k;
                offset = offset >= 0 ? offset : ~offset;
                for (int i = path.Starts[rows]; i < path.Starts[rows + 1]; i++)
                {
                    for (int j = path.Starts[columns]; j < path.Starts[columns + 1]; j++)
                    {
                        _matrix[offset++] += matrix[i * width + j];
                    }
                }
            }
        }
    }

    /// <summary>Replaces Step by the damped step; the matrix is used up.</summary>
    /// <param name="damping">mu as a share of 1 plus the largest diagonal entry.</param>
    public void Solve(double damping)
    {
        if (_isDual && _dual.IsSmall)
        {
            _largest = _dual.Solve(damping, _step);
            return;
        }

        if (_isDual)
        {
            LeaveDual();
        }

        double largest = 1;
        foreach (BlockPattern.Column column in _pattern.Columns)
        {
            for (int i = 0; i < column.Size; i++)
            {
                largest = Math.Max(largest, _matrix[column.Diagonal + i * (column.Size + 1)]);
            }
        }

        _largest = largest;
        double mu = damping * largest;
        foreach (BlockPattern.Column column in _pattern.Columns)
        {
            for (int i = 0; i < column.Size; i++)
            {
                _matrix[column.Diagonal + i * (column.Size + 1)] += mu;
                _step[column.Row + i] = -_step[column.Row + i];
            }
        }

        BlockCholesky<ScalarLane>.Factor(_pattern, _matrix);
        BlockCholesky<ScalarLane>.Solve(_pattern, _matrix, _step);
        foreach (BlockPattern.Column column in _pattern.Columns)
        {
            for (int i = 0; i < column.Size; i++)
            {
                // The factor's diagonal is stored inverted.
                _pivots[column.Row + i] = 1 / _matrix[column.Diagonal + i * (column.Size + 1)];
            }
        }
    }

    /// <summary>Factors the damped matrix of some rows alone.</summary>
    public void Factor(PackedRows rows, double damping)
    {
        Clear();
        if (_isDual)
        {
            LeaveDual();
        }

        for (int r = 0; r < rows.Count; r++)
        {
            AddToMatrix(rows.Path(r), rows.Row(r), 0);
        }

        Solve(damping);
    }

    /// <summary>Replaces Step by the damped step for J^T C, with the matrix last factored.</summary>
    public void SolveFor(double[] gradient)
    {
        for (int i = 0; i < _step.Length; i++)
        {
            _step[i] = -gradient[i];
        }

        BlockCholesky<ScalarLane>.Solve(_pattern, _matrix, _step);
    }

    /// <summary>Spare freedoms and pivots of the last Solve that are less than a share of the largest entry: about as many freedoms are left over.</summary>
    public int LeftOver(double share)
    {
        int count = Spare;
        foreach (double pivot in Pivots)
        {
            count += pivot < share * _largest ? 1 : 0;
        }

        return count;
    }

    private void AddProduct(int offset, ReadOnlySpan<double> rows, ReadOnlySpan<double> columns)
    {
        for (int i = 0; i < rows.Length; i++)
        {
            for (int j = 0; j < columns.Length; j++)
            {
                _matrix[offset++] += rows[i] * columns[j];
            }
        }
    }

    // All of a path's bodies with each other: of long paths these are many.
    private static IEnumerable<(int A, int B)> Couplings(IReadOnlyList<RowPath> paths, int[] node)
    {
        foreach (RowPath path in paths)
        {
            for (int k = 0; k < path.Bodies.Length; k++)
            {
                for (int l = 0; l < k; l++)
                {
                    yield return (node[path.Bodies[k]], node[path.Bodies[l]]);
                }
            }
        }
    }

    // For each pair k >= l: the offset of its block, or the complement where the block's rows are l's.
    private int[] BlocksOf(RowPath path, int[] node)
    {
        var blocks = new int[path.Bodies.Length * (path.Bodies.Length + 1) / 2];
        int next = 0;
        for (int k = 0; k < path.Bodies.Length; k++)
        {
            int nk = node[path.Bodies[k]];
            for (int l = 0; l < k; l++)
            {
                int nl = node[path.Bodies[l]];
                blocks[next++] = _pattern.IsBefore(nl, nk) ? _pattern.Below(nk, nl) : ~_pattern.Below(nl, nk);
            }

            blocks[next++] = _pattern.Diagonal(nk);
        }

        return blocks;
    }
}
