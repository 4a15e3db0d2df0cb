using System;

namespace Kinefab.Kinematics;

/// <summary>
/// The damped step from few rows over many freedoms: dy = -J^T (J J^T + mu I)^-1 C, which is the step of
/// <see cref="NormalEquations"/> for a matrix as small as the rows are few. A ring of a hundred bars has six rows.
/// </summary>
internal sealed class DualEquations
{
    /// <summary>Rows from which on the block-sparse matrix is the better one.</summary>
    public const int MaxRows = 24;

    private readonly int[] _firsts;
    private readonly int _freedoms;
    private readonly RowPath[] _paths = new RowPath[MaxRows];
    private readonly double[] _rows;
    private readonly double[] _c = new double[MaxRows];
    private readonly double[] _matrix = new double[MaxRows * MaxRows];
    private readonly double[] _pivots = new double[MaxRows];
    private readonly double[] _dense;
    private readonly double[] _squares;

    /// <summary>With no rows.</summary>
    /// <param name="firsts">For each body the place of its first freedom in a step.</param>
    /// <param name="freedoms">Number of freedoms.</param>
    public DualEquations(int[] firsts, int freedoms)
    {
        _firsts = firsts;
        _freedoms = freedoms;
        _rows = new double[MaxRows * freedoms];
        _dense = new double[freedoms];
        _squares = new double[freedoms];
    }

    /// <summary>Number of rows held.</summary>
    public int Count { get; private set; }

    /// <summary>Few enough, against the freedoms, to be solved here.</summary>
    public bool IsSmall => 2 * Count <= _freedoms;

    /// <summary>Pivots of the last Solve.</summary>
    public ReadOnlySpan<double> Pivots => _pivots.AsSpan(0, Count);

    /// <summary>Forgets all rows.</summary>
    public void Clear() => Count = 0;

    /// <summary>Holds one more row; there must be less than <see cref="MaxRows"/>.</summary>
    public void Add(RowPath path, ReadOnlySpan<double> row, double c)
    {
        _paths[Count] = path;
        _c[Count] = c;
        row.CopyTo(_rows.AsSpan(Count * _freedoms));
        Count++;
    }

    /// <summary>A row held, packed along its path, and its C.</summary>
    public ReadOnlySpan<double> Row(int index, out RowPath path, out double c)
    {
        path = _paths[index];
        c = _c[index];
        return _rows.AsSpan(index * _freedoms, path.Width);
    }

    /// <summary>The step, and the largest entry on the diagonal of J^T J, or 1.</summary>
    public double Solve(double damping, double[] step)
    {
        Array.Clear(_squares, 0, _freedoms);
        for (int i = 0; i < Count; i++)
        {
            Spread(i);
            for (int j = 0; j <= i; j++)
            {
                _matrix[i * MaxRows + j] = Dot(j);
            }

            Wipe(i);
        }

        double largest = 1;
        foreach (double square in _squares)
        {
            largest = Math.Max(largest, square);
        }

        Factor(damping * largest);
        Substitute();
        Array.Clear(step, 0, step.Length);
        for (int i = 0; i < Count; i++)
        {
            ReadOnlySpan<double> row = Row(i, out RowPath path, out double z);
            for (int k = 0; k < path.Bodies.Length; k++)
            {
                int first = _firsts[path.Bodies[k]] - path.Starts[k];
                for (int e = path.Starts[k]; e < path.Starts[k + 1]; e++)
                {
                    step[first + e] -= row[e] * z;
                }
            }
        }

        return largest;
    }

    private void Spread(int index)
    {
        ReadOnlySpan<double> row = Row(index, out RowPath path, out _);
        for (int k = 0; k < path.Bodies.Length; k++)
        {
            int first = _firsts[path.Bodies[k]] - path.Starts[k];
            for (int e = path.Starts[k]; e < path.Starts[k + 1]; e++)
            {
                _dense[first + e] = row[e];
                _squares[first + e] += row[e] * row[e];
            }
        }
    }

    private void Wipe(int index)
    {
        RowPath path = _paths[index];
        for (int k = 0; k < path.Bodies.Length; k++)
        {
            Array.Clear(_dense, _firsts[path.Bodies[k]], path.Starts[k + 1] - path.Starts[k]);
        }
    }

    private double Dot(int index)
    {
        ReadOnlySpan<double> row = Row(index, out RowPath path, out _);
        double sum = 0;
        for (int k = 0; k < path.Bodies.Length; k++)
        {
            int first = _firsts[path.Bodies[k]] - path.Starts[k];
            for (int e = path.Starts[k]; e < path.Starts[k + 1]; e++)
            {
                sum += row[e] * _dense[first + e];
            }
        }

        return sum;
    }

    // Cholesky of the lower triangle; mu keeps every pivot positive.
    private void Factor(double mu)
    {
        for (int i = 0; i < Count; i++)
        {
            for (int j = 0; j <= i; j++)
            {
                double s = _matrix[i * MaxRows + j] + (i == j ? mu : 0);
                for (int t = 0; t < j; t++)
                {
                    s -= _matrix[i * MaxRows + t] * _matrix[j * MaxRows + t];
                }

                if (i == j)
                {
                    _pivots[i] = Math.Max(s, 1e-30);
                    _matrix[i * MaxRows + i] = Math.Sqrt(_pivots[i]);
                }
                else
                {
                    _matrix[i * MaxRows + j] = s / _matrix[j * MaxRows + j];
                }
            }
        }
    }

    // C becomes z.
    private void Substitute()
    {
        for (int i = 0; i < Count; i++)
        {
            for (int t = 0; t < i; t++)
            {
                _c[i] -= _matrix[i * MaxRows + t] * _c[t];
            }

            _c[i] /= _matrix[i * MaxRows + i];
        }

        for (int i = Count - 1; i >= 0; i--)
        {
            for (int t = i + 1; t < Count; t++)
            {
                _c[i] -= _matrix[t * MaxRows + i] * _c[t];
            }

            _c[i] /= _matrix[i * MaxRows + i];
        }
    }
}
