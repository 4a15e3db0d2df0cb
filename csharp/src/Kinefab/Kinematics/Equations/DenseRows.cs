using System;
using System.Collections.Generic;

namespace Kinefab.Kinematics;

/// <summary>Collects rows over the tree's freedoms as a dense matrix.</summary>
internal sealed class DenseRows : IRowSink
{
    private readonly int[] _firsts;
    private readonly int _columns;
    private readonly List<double[]> _rows = new();
    private readonly List<double> _errors = new();

    /// <summary>An empty matrix.</summary>
    /// <param name="firsts">For each body the column of its first freedom.</param>
    /// <param name="columns">Number of freedoms.</param>
    public DenseRows(int[] firsts, int columns)
    {
        _firsts = firsts;
        _columns = columns;
    }

    /// <summary>Number of rows.</summary>
    public int Count => _rows.Count;

    /// <summary>What each row misses 0 by.</summary>
    public IReadOnlyList<double> Errors => _errors;

    /// <inheritdoc/>
    public void Add(RowPath path, ReadOnlySpan<double> row, double c)
    {
        var dense = new double[_columns];
        for (int k = 0; k < path.Bodies.Length; k++)
        {
            row[path.Starts[k]..path.Starts[k + 1]].CopyTo(dense.AsSpan(_firsts[path.Bodies[k]]));
        }

        _rows.Add(dense);
        _errors.Add(c);
    }

    /// <summary>The rows of one block over its columns.</summary>
    public double[,] Matrix(IReadOnlyList<int> columns, int block, int[] blockOf)
    {
        var chosen = new List<double[]>();
        foreach (double[] row in _rows)
        {
            int first = Array.FindIndex(row, entry => entry != 0);
            if (first >= 0 && blockOf[first] == block)
            {
                chosen.Add(row);
            }
        }

        return Matrix(chosen, columns);
    }

    /// <summary>The chosen columns of all rows.</summary>
    public double[,] Matrix(IReadOnlyList<int> columns) => Matrix(_rows, columns);

    /// <summary>A row, over all columns.</summary>
    public double[] Row(int index) => _rows[index];

    private static double[,] Matrix(List<double[]> rows, IReadOnlyList<int> columns)
    {
        var matrix = new double[rows.Count, columns.Count];
        for (int i = 0; i < rows.Count; i++)
        {
            for (int j = 0; j < columns.Count; j++)
            {
                matrix[i, j] = rows[i][columns[j]];
            }
        }

        return matrix;
    }
}
