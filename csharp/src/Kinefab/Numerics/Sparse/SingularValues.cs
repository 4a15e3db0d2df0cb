using System;
using System.Collections.Generic;

namespace Kinefab.Numerics;

/// <summary>
/// Singular values and right singular vectors of a small dense matrix by one-sided Jacobi rotations, which find even tiny
/// singular values to full relative accuracy of the columns. Source: Demmel and Veselic 1992.
/// </summary>
internal sealed class SingularValues
{
    private const int MaxSweeps = 60;
    private const double Orthogonal = 1e-15;

    private readonly double[,] _vectors;

    /// <summary>Decomposes a matrix, which is used up.</summary>
    /// <param name="matrix">Rows by columns; any of both may be 0.</param>
    public SingularValues(double[,] matrix)
    {
        if (matrix is null)
            throw new ArgumentNullException(nameof(matrix));
        int columns = matrix.GetLength(1);
        // Columns are rotated, so they lie in rows of their own here.
        double[][] a = Columns(matrix, columns);
        var v = new double[columns][];
        for (int i = 0; i < columns; i++)
        {
            v[i] = new double[columns];
            v[i][i] = 1;
        }

        double[] squares = Array.ConvertAll(a, column => DenseVector.Dot(column, column));
        for (int sweep = 0; sweep < MaxSweeps && Sweep(a, v, squares); sweep++)
        {
        }

        var lengths = new double[columns];
        var order = new int[columns];
        for (int i = 0; i < columns; i++)
        {
            lengths[i] = Math.Sqrt(squares[i]);
            order[i] = i;
        }

        Array.Sort(order, (i, j) => lengths[i] == lengths[j] ? i.CompareTo(j) : lengths[j].CompareTo(lengths[i]));
        Values = new double[columns];
        _vectors = new double[columns, columns];
        for (int k = 0; k < columns; k++)
        {
            Values[k] = lengths[order[k]];
            for (int i = 0; i < columns; i++)
            {
                _vectors[i, k] = v[order[k]][i];
            }
        }
    }

    /// <summary>Of columns, which are kept; all as long.</summary>
    public static SingularValues OfColumns(IReadOnlyList<double[]> columns)
    {
        var matrix = new double[columns.Count == 0 ? 0 : columns[0].Length, columns.Count];
        for (int j = 0; j < columns.Count; j++)
        {
            for (int i = 0; i < columns[j].Length; i++)
            {
                matrix[i, j] = columns[j][i];
            }
        }

        return new SingularValues(matrix);
    }

    /// <summary>One for each column, falling.</summary>
    public double[] Values { get; }

    /// <summary>Number of the values above a bound.</summary>
    public int Rank(double bound) => Array.FindAll(Values, value => value > bound).Length;

    /// <summary>Entry of the right singular vector that belongs to a value.</summary>
    public double Vector(int entry, int value) => _vectors[entry, value];

    private static double[][] Columns(double[,] matrix, int columns)
    {
        int rows = matrix.GetLength(0);
        var a = new double[columns][];
        for (int j = 0; j < columns; j++)
        {
            a[j] = new double[rows];
            for (int i = 0; i < rows; i++)
            {
                a[j][i] = matrix[i, j];
            }
        }

        return a;
    }

    // squares: of the columns' lengths, as they stand.
    private static bool Sweep(double[][] a, double[][] v, double[] squares)
    {
        bool rotated = false;
        for (int i = 0; i < a.Length; i++)
        {
            for (int j = i + 1; j < a.Length; j++)
            {
                double p = squares[i];
                double q = squares[j];
                double r = DenseVector.Dot(a[i], a[j]);
                if (Math.Abs(r) <= Orthogonal * Math.Sqrt(p * q) || r == 0)
                {
                    continue;
                }

                rotated = true;
                double zeta = (q - p) / (2 * r);
                double t = (zeta < 0 ? -1 : 1) / (Math.Abs(zeta) + Math.Sqrt(1 + zeta * zeta));
                double c = 1 / Math.Sqrt(1 + t * t);
                (squares[i], squares[j]) = Rotate(a[i], a[j], c, c * t);
                _ = Rotate(v[i], v[j], c, c * t);
            }
        }

        return rotated;
    }

    // Returns the squares of both lengths after it.
    private static (double X, double Y) Rotate(double[] x, double[] y, double c, double s)
    {
        (double xx, double yy) = (0, 0);
        for (int i = 0; i < x.Length && i < y.Length; i++)
        {
            (double a, double b) = (c * x[i] - s * y[i], s * x[i] + c * y[i]);
            (x[i], y[i]) = (a, b);
            xx += a * a;
            yy += b * b;
        }

        return (xx, yy);
    }
}
