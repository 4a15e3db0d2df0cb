using System;
using System.Collections.Generic;

namespace Kinefab.Kinematics;

/// <summary>Collects rows over the tree's freedoms, each as long as its path.</summary>
internal sealed class PackedRows
{
    private readonly int[] _firsts;
    private readonly List<RowPath> _paths = new();
    private readonly List<double[]> _rows = new();
    private readonly List<double> _errors = new();

    /// <summary>No rows yet.</summary>
    /// <param name="firsts">For each body the column of its first freedom.</param>
    public PackedRows(int[] firsts) => _firsts = firsts;

    /// <summary>Number of rows.</summary>
    public int Count => _rows.Count;

    /// <summary>What each row misses 0 by.</summary>
    public IReadOnlyList<double> Errors => _errors;

    /// <summary>Takes one more row.</summary>
    /// <param name="path">Its bodies.</param>
    /// <param name="row">Its entries along the path.</param>
    /// <param name="c">What it misses 0 by.</param>
    public void Add(RowPath path, ReadOnlySpan<double> row, double c)
    {
        _paths.Add(path);
        _rows.Add(row[..path.Width].ToArray());
        _errors.Add(c);
    }

    /// <summary>A row's entries along its path.</summary>
    public double[] Row(int index) => _rows[index];

    /// <summary>A row's path.</summary>
    public RowPath Path(int index) => _paths[index];

    /// <summary>The rows of one block, of those that are not zero.</summary>
    /// <param name="block">Which.</param>
    /// <param name="blockOf">For each freedom its block.</param>
    public List<int> Of(int block, int[] blockOf)
    {
        var chosen = new List<int>();
        for (int r = 0; r < Count; r++)
        {
            if (Array.Exists(_rows[r], entry => entry != 0) && blockOf[_firsts[_paths[r].Bodies[0]]] == block)
            {
                chosen.Add(r);
            }
        }

        return chosen;
    }

    /// <summary>All rows over so many columns, as a dense matrix.</summary>
    public double[,] Matrix(int columns)
    {
        var matrix = new double[Count, columns];
        for (int r = 0; r < Count; r++)
        {
            int entry = 0;
            foreach (int column in Columns(r))
            {
                matrix[r, column] = _rows[r][entry++];
            }
        }

        return matrix;
    }

    /// <summary>How fast a velocity of all freedoms changes what each row misses 0 by.</summary>
    public double[] Times(double[] velocity)
    {
        var rates = new double[Count];
        for (int r = 0; r < rates.Length; r++)
        {
            int entry = 0;
            foreach (int column in Columns(r))
            {
                rates[r] += _rows[r][entry++] * velocity[column];
            }
        }

        return rates;
    }

    /// <summary>The sum of the rows, each times a number.</summary>
    public double[] TransposeTimes(IReadOnlyList<double> numbers, int columns)
    {
        var sum = new double[columns];
        for (int r = 0; r < Count; r++)
        {
            int entry = 0;
            foreach (int column in Columns(r))
            {
                sum[column] += _rows[r][entry++] * numbers[r];
            }
        }

        return sum;
    }

    /// <summary>For each entry of a row its column.</summary>
    public int[] Columns(int index)
    {
        RowPath path = _paths[index];
        var columns = new int[path.Width];
        for (int k = 0; k < path.Bodies.Length; k++)
        {
            for (int i = path.Starts[k]; i < path.Starts[k + 1]; i++)
            {
                columns[i] = _firsts[path.Bodies[k]] + i - path.Starts[k];
            }
        }

        return columns;
    }
}
