using System.Runtime.CompilerServices;
using System.Threading;

namespace Kinefab.Numerics;

/// <summary>
/// A = L D L^T in place for symmetric block-sparse matrices of one pattern, several at a time in lanes; D is positive for the rows of
/// positive nodes, negative for those of negative ones. No roots: next to a division each is the longest wait of the whole factor. Number i of the
/// pattern stands at i * width in the array. A diagonal block keeps the factor of its own, T D T^T, its D inverted; below it stands L D. The first
/// five rows of a node, those of a hinge, go through registers; the order of operations is the same for all sizes.
/// </summary>
internal static class BlockCholesky<V>
    where V : struct, ILane<V>
{
    private const int Five = 5;

    // Instead of a number of columns, which may be none.
    private const int Triangle = -1;

    // Before a factor looks whether it was cancelled: those of the many small mechanisms never do.
    private const int ColumnsBetweenLooks = 64;

    // A pivot lost to rounding is replaced, so that the result stays finite; the caller's residual then tells.
    private const double LeastPivot = 1e-30;

    /// <summary>Replaces the matrix by its factor.</summary>
    /// <param name="pattern">Where its blocks stand.</param>
    /// <param name="a">The matrix.</param>
    /// <param name="cancellation">Ends it early, with an OperationCanceledException, and leaves neither matrix nor factor.</param>
    public static void Factor(BlockPattern pattern, double[] a, CancellationToken cancellation = default)
    {
        int w = Lane<V>.Width;
        BlockPattern.Column[] columns = pattern.Columns;
        for (int turn = 0; turn < columns.Length; turn++)
        {
            if (turn % ColumnsBetweenLooks == ColumnsBetweenLooks - 1)
            {
                cancellation.ThrowIfCancellationRequested();
            }

            BlockPattern.Column column = columns[turn];
            int n = column.Size;
            int diagonal = column.Diagonal * w;
            if (column.IsNegative)
            {
                Negate(a, diagonal, n * n, w);
            }

            FactorDiagonal(a, diagonal, n);
            if (column.IsNegative)
            {
                Negate(a, diagonal, n, (n + 1) * w);
            }

            BlockPattern.Block[] below = column.Below;
            int product = 0;
            for (int i = 0; i < below.Length; i++)
            {
                int x = below[i].Offset * w;
                Forward(a, diagonal, a, x, n, below[i].Size);
                for (int k = 0; k <= i; k++)
                {
                    SubtractProduct(a, column.Products[product++] * w, x, below[i].Size, below[k].Offset * w, k < i ? below[k].Size : Triangle, n, diagonal);
                }
            }
        }
    }

    /// <summary>Replaces b by the solution x of A x = b, with A's factor.</summary>
    public static void Solve(BlockPattern pattern, double[] a, double[] b)
    {
        int w = Lane<V>.Width;
        BlockPattern.Column[] columns = pattern.Columns;
        foreach (BlockPattern.Column column in columns)
        {
            Forward(a, column.Diagonal * w, b, column.Row * w, column.Size, 1);
            foreach (BlockPattern.Block block in column.Below)
            {
                SubtractRows(a, block.Offset * w, block.Size, column.Size, column.Diagonal * w, b, column.Row * w, block.Row * w);
            }
        }

        for (int turn = columns.Length - 1; turn >= 0; turn--)
        {
            BlockPattern.Column column = columns[turn];
            foreach (BlockPattern.Block block in column.Below)
            {
                SubtractTransposed(a, block.Offset * w, block.Size, column.Size, b, block.Row * w, column.Row * w);
            }

            Backward(a, column.Diagonal * w, b, column.Row * w, column.Size);
        }
    }

    private static void Negate(double[] a, int at, int count, int step)
    {
        for (; count > 0; count--, at += step)
        {
            (Lane<V>.Splat(0) - Lane<V>.Load(a, at)).Store(a, at);
        }
    }

    private static void FactorDiagonal(double[] a, int diagonal, int n)
    {
        int w = Lane<V>.Width;
        int first = 0;
        if (n >= Five)
        {
            FactorFive(a, diagonal, n * w);
            first = Five;
        }

        int row = diagonal + first * n * w;
        for (int i = first; i < n; i++, row += n * w)
        {
            Lane<V> pivot = Lane<V>.Load(a, row + i * w);
            int other = diagonal;
            for (int j = 0; j < i; j++, other += n * w)
            {
                Lane<V> s = Lane<V>.Load(a, row + j * w);
                for (int t = 0; t < j * w; t += w)
                {
                    s -= Lane<V>.Load(a, row + t) * Lane<V>.Load(a, other + t);
                }

                s.Store(a, row + j * w);
            }

            other = diagonal;
            for (int j = 0; j < i; j++, other += (n + 1) * w)
            {
                Lane<V> s = Lane<V>.Load(a, row + j * w);
                Lane<V> scaled = s * Lane<V>.Load(a, other);
                scaled.Store(a, row + j * w);
                pivot -= s * scaled;
            }

            Inverse(pivot).Store(a, row + i * w);
        }
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void FactorFive(double[] a, int g, int stride)
    {
        int row1 = g + stride, row2 = row1 + stride, row3 = row2 + stride, row4 = row3 + stride;
        Lane<V> d = Inverse(Lane<V>.Load(a, g));
        d.Store(a, g);
        Lane<V> s1 = Lane<V>.Load(a, row1), s2 = Lane<V>.Load(a, row2), s3 = Lane<V>.Load(a, row3), s4 = Lane<V>.Load(a, row4);
        Lane<V> t1 = s1 * d, t2 = s2 * d, t3 = s3 * d, t4 = s4 * d;
        t1.Store(a, row1);
        t2.Store(a, row2);
        t3.Store(a, row3);
        t4.Store(a, row4);
        Lane<V> d11 = Lane<V>.Load(a, row1, 1) - s1 * t1;
        Lane<V> d21 = Lane<V>.Load(a, row2, 1) - s2 * t1, d22 = Lane<V>.Load(a, row2, 2) - s2 * t2;
        Lane<V> d31 = Lane<V>.Load(a, row3, 1) - s3 * t1, d32 = Lane<V>.Load(a, row3, 2) - s3 * t2, d33 = Lane<V>.Load(a, row3, 3) - s3 * t3;
        Lane<V> d41 = Lane<V>.Load(a, row4, 1) - s4 * t1, d42 = Lane<V>.Load(a, row4, 2) - s4 * t2;
        Lane<V> d43 = Lane<V>.Load(a, row4, 3) - s4 * t3, d44 = Lane<V>.Load(a, row4, 4) - s4 * t4;
        d = Inverse(d11);
        d.Store(a, row1, 1);
        t2 = d21 * d;
        t3 = d31 * d;
        t4 = d41 * d;
        t2.Store(a, row2, 1);
        t3.Store(a, row3, 1);
        t4.Store(a, row4, 1);
        d22 -= d21 * t2;
        d32 -= d31 * t2;
        d33 -= d31 * t3;
        d42 -= d41 * t2;
        d43 -= d41 * t3;
        d44 -= d41 * t4;
        d = Inverse(d22);
        d.Store(a, row2, 2);
        t3 = d32 * d;
        t4 = d42 * d;
        t3.Store(a, row3, 2);
        t4.Store(a, row4, 2);
        d33 -= d32 * t3;
        d43 -= d42 * t3;
        d44 -= d42 * t4;
        d = Inverse(d33);
        d.Store(a, row3, 3);
        t4 = d43 * d;
        t4.Store(a, row4, 3);
        Inverse(d44 - d43 * t4).Store(a, row4, 4);
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static Lane<V> Inverse(Lane<V> pivot) => Lane<V>.Splat(1) / Lane<V>.Max(pivot, Lane<V>.Splat(LeastPivot));

    // T x = b in place, for so many b one after the other.
    private static void Forward(double[] a, int diagonal, double[] b, int at, int n, int count)
    {
        int w = Lane<V>.Width;
        int first = 1;
        if (n >= Five)
        {
            ForwardFive(a, diagonal, n * w, b, at, count);
            first = Five;
        }

        for (int end = at + count * n * w; first < n && at < end; at += n * w)
        {
            int row = diagonal + first * n * w;
            for (int i = first; i < n; i++, row += n * w)
            {
                Lane<V> s = Lane<V>.Load(b, at + i * w);
                for (int t = 0; t < i * w; t += w)
                {
                    s -= Lane<V>.Load(a, row + t) * Lane<V>.Load(b, at + t);
                }

                s.Store(b, at + i * w);
            }
        }
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void ForwardFive(double[] a, int g, int stride, double[] b, int at, int count)
    {
        int row1 = g + stride, row2 = row1 + stride, row3 = row2 + stride, row4 = row3 + stride;
        Lane<V> t10 = Lane<V>.Load(a, row1), t20 = Lane<V>.Load(a, row2), t21 = Lane<V>.Load(a, row2, 1);
        Lane<V> t30 = Lane<V>.Load(a, row3), t31 = Lane<V>.Load(a, row3, 1), t32 = Lane<V>.Load(a, row3, 2);
        Lane<V> t40 = Lane<V>.Load(a, row4), t41 = Lane<V>.Load(a, row4, 1), t42 = Lane<V>.Load(a, row4, 2), t43 = Lane<V>.Load(a, row4, 3);
        for (; count > 0; count--, at += stride)
        {
            Lane<V> x0 = Lane<V>.Load(b, at);
            Lane<V> x1 = Lane<V>.Load(b, at, 1) - x0 * t10;
            x1.Store(b, at, 1);
            Lane<V> x2 = Lane<V>.Load(b, at, 2) - x0 * t20 - x1 * t21;
            x2.Store(b, at, 2);
            Lane<V> x3 = Lane<V>.Load(b, at, 3) - x0 * t30 - x1 * t31 - x2 * t32;
            x3.Store(b, at, 3);
            (Lane<V>.Load(b, at, 4) - x0 * t40 - x1 * t41 - x2 * t42 - x3 * t43).Store(b, at, 4);
        }
    }

    // T^T x = D^-1 b in place.
    private static void Backward(double[] a, int diagonal, double[] b, int at, int n)
    {
        int w = Lane<V>.Width;
        if (n == Five)
        {
            BackwardFive(a, diagonal, n * w, b, at, true);
            return;
        }

        int pivot = diagonal;
        for (int i = 0; i < n * w; i += w, pivot += (n + 1) * w)
        {
            (Lane<V>.Load(b, at + i) * Lane<V>.Load(a, pivot)).Store(b, at + i);
        }

        int last = n > Five ? Five : 0;
        for (int t = n - 1; t >= last; t--)
        {
            int row = diagonal + t * n * w;
            Lane<V> x = Lane<V>.Load(b, at + t * w);
            for (int i = 0; i < t * w; i += w)
            {
                (Lane<V>.Load(b, at + i) - Lane<V>.Load(a, row + i) * x).Store(b, at + i);
            }
        }

        if (last > 0)
        {
            BackwardFive(a, diagonal, n * w, b, at, false);
        }
    }

    // Scales: whether b is still to be multiplied by the inverse pivots.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void BackwardFive(double[] a, int g, int stride, double[] b, int at, bool scales)
    {
        int row1 = g + stride, row2 = row1 + stride, row3 = row2 + stride, row4 = row3 + stride;
        Lane<V> x0 = Lane<V>.Load(b, at), x1 = Lane<V>.Load(b, at, 1), x2 = Lane<V>.Load(b, at, 2), x3 = Lane<V>.Load(b, at, 3), x4 = Lane<V>.Load(b, at, 4);
        if (scales)
        {
            x0 *= Lane<V>.Load(a, g);
            x1 *= Lane<V>.Load(a, row1, 1);
            x2 *= Lane<V>.Load(a, row2, 2);
            x3 *= Lane<V>.Load(a, row3, 3);
            x4 *= Lane<V>.Load(a, row4, 4);
            x4.Store(b, at, 4);
        }

        x3 -= x4 * Lane<V>.Load(a, row4, 3);
        x3.Store(b, at, 3);
        x2 = x2 - x4 * Lane<V>.Load(a, row4, 2) - x3 * Lane<V>.Load(a, row3, 2);
        x2.Store(b, at, 2);
        x1 = x1 - x4 * Lane<V>.Load(a, row4, 1) - x3 * Lane<V>.Load(a, row3, 1) - x2 * Lane<V>.Load(a, row2, 1);
        x1.Store(b, at, 1);
        (x0 - x4 * Lane<V>.Load(a, row4) - x3 * Lane<V>.Load(a, row3) - x2 * Lane<V>.Load(a, row2) - x1 * Lane<V>.Load(a, row1)).Store(b, at);
    }

    // C -= X D^-1 Y^T, X m x n, Y k x n; for Triangle the lower triangle of C -= X D^-1 X^T.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void SubtractProduct(double[] a, int c, int x, int m, int y, int k, int n, int pivot)
    {
        int w = Lane<V>.Width;
        int step = (n + 1) * w;
        int columns = k == Triangle ? m : k;
        for (int i = 0; i < m; i++, x += n * w, c += columns * w)
        {
            int end = c + (k == Triangle ? i + 1 : k) * w;
            int t = 0;
            if (n >= Five)
            {
                Lane<V> x0 = Lane<V>.Load(a, x) * Lane<V>.Load(a, pivot), x1 = Lane<V>.Load(a, x, 1) * Lane<V>.Load(a, pivot + step);
                Lane<V> x2 = Lane<V>.Load(a, x, 2) * Lane<V>.Load(a, pivot + 2 * step), x3 = Lane<V>.Load(a, x, 3) * Lane<V>.Load(a, pivot + 3 * step);
                Lane<V> x4 = Lane<V>.Load(a, x, 4) * Lane<V>.Load(a, pivot + 4 * step);
                int row = y;
                for (int to = c; to < end; to += w, row += n * w)
                {
                    Lane<V> sum = ((x0 * Lane<V>.Load(a, row) + x1 * Lane<V>.Load(a, row, 1)) + (x2 * Lane<V>.Load(a, row, 2) + x3 * Lane<V>.Load(a, row, 3)))
                        + x4 * Lane<V>.Load(a, row, 4);
                    (Lane<V>.Load(a, to) - sum).Store(a, to);
                }

                t = Five;
            }

            for (; t < n; t++)
            {
                Lane<V> xt = Lane<V>.Load(a, x + t * w) * Lane<V>.Load(a, pivot + t * step);
                int cell = y + t * w;
                for (int to = c; to < end; to += w, cell += n * w)
                {
                    (Lane<V>.Load(a, to) - xt * Lane<V>.Load(a, cell)).Store(a, to);
                }
            }
        }
    }

    // to -= M D^-1 from, M m x n.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void SubtractRows(double[] a, int matrix, int m, int n, int pivot, double[] b, int from, int to)
    {
        int w = Lane<V>.Width;
        int step = (n + 1) * w;
        int t = 0;
        if (n >= Five)
        {
            Lane<V> x0 = Lane<V>.Load(b, from) * Lane<V>.Load(a, pivot), x1 = Lane<V>.Load(b, from, 1) * Lane<V>.Load(a, pivot + step);
            Lane<V> x2 = Lane<V>.Load(b, from, 2) * Lane<V>.Load(a, pivot + 2 * step), x3 = Lane<V>.Load(b, from, 3) * Lane<V>.Load(a, pivot + 3 * step);
            Lane<V> x4 = Lane<V>.Load(b, from, 4) * Lane<V>.Load(a, pivot + 4 * step);
            int row = matrix;
            int end = to + m * w;
            for (int at = to; at < end; at += w, row += n * w)
            {
                Lane<V> sum = ((x0 * Lane<V>.Load(a, row) + x1 * Lane<V>.Load(a, row, 1)) + (x2 * Lane<V>.Load(a, row, 2) + x3 * Lane<V>.Load(a, row, 3)))
                    + x4 * Lane<V>.Load(a, row, 4);
                (Lane<V>.Load(b, at) - sum).Store(b, at);
            }

            t = Five;
        }

        for (; t < n; t++)
        {
            Lane<V> x = Lane<V>.Load(b, from + t * w) * Lane<V>.Load(a, pivot + t * step);
            int cell = matrix + t * w;
            int end = to + m * w;
            for (int at = to; at < end; at += w, cell += n * w)
            {
                (Lane<V>.Load(b, at) - x * Lane<V>.Load(a, cell)).Store(b, at);
            }
        }
    }

    // to -= M^T from, M m x n.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void SubtractTransposed(double[] a, int matrix, int m, int n, double[] b, int from, int to)
    {
        int w = Lane<V>.Width;
        int i = 0;
        if (n >= Five)
        {
            Lane<V> s0 = Lane<V>.Load(b, to), s1 = Lane<V>.Load(b, to, 1), s2 = Lane<V>.Load(b, to, 2);
            Lane<V> s3 = Lane<V>.Load(b, to, 3), s4 = Lane<V>.Load(b, to, 4);
            int row = matrix;
            for (int t = 0; t < m * w; t += w, row += n * w)
            {
                Lane<V> x = Lane<V>.Load(b, from + t);
                s0 -= x * Lane<V>.Load(a, row);
                s1 -= x * Lane<V>.Load(a, row, 1);
                s2 -= x * Lane<V>.Load(a, row, 2);
                s3 -= x * Lane<V>.Load(a, row, 3);
                s4 -= x * Lane<V>.Load(a, row, 4);
            }

            s0.Store(b, to);
            s1.Store(b, to, 1);
            s2.Store(b, to, 2);
            s3.Store(b, to, 3);
            s4.Store(b, to, 4);
            i = Five;
        }

        for (; i < n; i++)
        {
            Lane<V> s = Lane<V>.Load(b, to + i * w);
            int cell = matrix + i * w;
            for (int t = 0; t < m * w; t += w, cell += n * w)
            {
                s -= Lane<V>.Load(b, from + t) * Lane<V>.Load(a, cell);
            }

            s.Store(b, to + i * w);
        }
    }
}
