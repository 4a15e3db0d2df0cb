using System.Runtime.CompilerServices;

namespace Kinefab.Numerics;

/// <summary>
/// A = G S G^T in place for symmetric block-sparse matrices of one pattern, several at a time in lanes; S is 1 for the rows of
/// positive nodes, -1 for those of negative ones. Number i of the pattern stands at i * width in the array. The factor's diagonal is stored inverted. The first five rows
/// of a node, those of a hinge, go through registers; the order of operations is the same for all sizes.
/// </summary>
internal static class BlockCholesky<V>
    where V : struct, ILane<V>
{
    private const int Five = 5;

    // Instead of a number of columns, which may be none.
    private const int Triangle = -1;

    // A pivot lost to rounding is replaced, so that the result stays finite; the caller's residual then tells.
    private const double LeastPivot = 1e-30;

    /// <summary>Replaces the matrix by its factor.</summary>
    public static void Factor(BlockPattern pattern, double[] a)
    {
        int w = Lane<V>.Width;
        foreach (BlockPattern.Column column in pattern.Columns)
        {
            int n = column.Size;
            int diagonal = column.Diagonal * w;
            if (column.IsNegative)
            {
                Negate(a, diagonal, n * n);
            }

            FactorDiagonal(a, diagonal, n);
            BlockPattern.Block[] below = column.Below;
            int product = 0;
            for (int i = 0; i < below.Length; i++)
            {
                int x = below[i].Offset * w;
                Forward(a, diagonal, a, x, n, below[i].Size);
                for (int k = 0; k <= i; k++)
                {
                    if (column.IsNegative)
                    {
                        AddProduct(a, column.Products[product++] * w, x, below[i].Size, below[k].Offset * w, k < i ? below[k].Size : Triangle, n);
                        continue;
                    }

                    SubtractProduct(a, column.Products[product++] * w, x, below[i].Size, a, below[k].Offset * w, k < i ? below[k].Size : Triangle, n);
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
            if (column.IsNegative)
            {
                Negate(b, column.Row * w, column.Size);
            }

            foreach (BlockPattern.Block block in column.Below)
            {
                SubtractProduct(b, block.Row * w, column.Row * w, 1, a, block.Offset * w, block.Size, column.Size);
            }
        }

        for (int turn = columns.Length - 1; turn >= 0; turn--)
        {
            BlockPattern.Column column = columns[turn];
            if (column.IsNegative)
            {
                Negate(b, column.Row * w, column.Size);
            }

            foreach (BlockPattern.Block block in column.Below)
            {
                SubtractTransposed(a, block.Offset * w, block.Size, column.Size, b, block.Row * w, column.Row * w);
            }

            Backward(a, column.Diagonal * w, b, column.Row * w, column.Size);
            if (column.IsNegative)
            {
                Negate(b, column.Row * w, column.Size);
            }
        }
    }

    private static void Negate(double[] a, int at, int count)
    {
        int w = Lane<V>.Width;
        for (int end = at + count * w; at < end; at += w)
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

                s *= Lane<V>.Load(a, other + j * w);
                s.Store(a, row + j * w);
                pivot -= s * s;
            }

            InverseRoot(pivot).Store(a, row + i * w);
        }
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void FactorFive(double[] a, int g, int stride)
    {
        int row1 = g + stride, row2 = row1 + stride, row3 = row2 + stride, row4 = row3 + stride;
        Lane<V> d = InverseRoot(Lane<V>.Load(a, g));
        d.Store(a, g);
        Lane<V> l10 = Lane<V>.Load(a, row1) * d, l20 = Lane<V>.Load(a, row2) * d, l30 = Lane<V>.Load(a, row3) * d, l40 = Lane<V>.Load(a, row4) * d;
        l10.Store(a, row1);
        l20.Store(a, row2);
        l30.Store(a, row3);
        l40.Store(a, row4);
        d = InverseRoot(Lane<V>.Load(a, row1, 1) - l10 * l10);
        d.Store(a, row1, 1);
        Lane<V> l21 = (Lane<V>.Load(a, row2, 1) - l20 * l10) * d;
        Lane<V> l31 = (Lane<V>.Load(a, row3, 1) - l30 * l10) * d;
        Lane<V> l41 = (Lane<V>.Load(a, row4, 1) - l40 * l10) * d;
        l21.Store(a, row2, 1);
        l31.Store(a, row3, 1);
        l41.Store(a, row4, 1);
        d = InverseRoot(Lane<V>.Load(a, row2, 2) - l20 * l20 - l21 * l21);
        d.Store(a, row2, 2);
        Lane<V> l32 = (Lane<V>.Load(a, row3, 2) - l30 * l20 - l31 * l21) * d;
        Lane<V> l42 = (Lane<V>.Load(a, row4, 2) - l40 * l20 - l41 * l21) * d;
        l32.Store(a, row3, 2);
        l42.Store(a, row4, 2);
        d = InverseRoot(Lane<V>.Load(a, row3, 3) - l30 * l30 - l31 * l31 - l32 * l32);
        d.Store(a, row3, 3);
        Lane<V> l43 = (Lane<V>.Load(a, row4, 3) - l40 * l30 - l41 * l31 - l42 * l32) * d;
        l43.Store(a, row4, 3);
        InverseRoot(Lane<V>.Load(a, row4, 4) - l40 * l40 - l41 * l41 - l42 * l42 - l43 * l43).Store(a, row4, 4);
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static Lane<V> InverseRoot(Lane<V> pivot) => Lane<V>.Splat(1) / Lane<V>.Sqrt(Lane<V>.Max(pivot, Lane<V>.Splat(LeastPivot)));

    // Solves G x = b in place, for so many b one after the other.
    private static void Forward(double[] a, int diagonal, double[] b, int at, int n, int count)
    {
        int w = Lane<V>.Width;
        int first = 0;
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

                (s * Lane<V>.Load(a, row + i * w)).Store(b, at + i * w);
            }
        }
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void ForwardFive(double[] a, int row0, int stride, double[] b, int at, int count)
    {
        int row1 = row0 + stride, row2 = row1 + stride, row3 = row2 + stride, row4 = row3 + stride;
        for (; count > 0; count--, at += stride)
        {
            Lane<V> x0 = Lane<V>.Load(b, at) * Lane<V>.Load(a, row0);
            x0.Store(b, at);
            Lane<V> x1 = (Lane<V>.Load(b, at, 1) - x0 * Lane<V>.Load(a, row1)) * Lane<V>.Load(a, row1, 1);
            x1.Store(b, at, 1);
            Lane<V> x2 = (Lane<V>.Load(b, at, 2) - x0 * Lane<V>.Load(a, row2) - x1 * Lane<V>.Load(a, row2, 1)) * Lane<V>.Load(a, row2, 2);
            x2.Store(b, at, 2);
            Lane<V> x3 = (Lane<V>.Load(b, at, 3) - x0 * Lane<V>.Load(a, row3) - x1 * Lane<V>.Load(a, row3, 1)
                - x2 * Lane<V>.Load(a, row3, 2)) * Lane<V>.Load(a, row3, 3);
            x3.Store(b, at, 3);
            Lane<V> x4 = (Lane<V>.Load(b, at, 4) - x0 * Lane<V>.Load(a, row4) - x1 * Lane<V>.Load(a, row4, 1)
                - x2 * Lane<V>.Load(a, row4, 2) - x3 * Lane<V>.Load(a, row4, 3)) * Lane<V>.Load(a, row4, 4);
            x4.Store(b, at, 4);
        }
    }

    // Solves G^T x = b in place.
    private static void Backward(double[] a, int diagonal, double[] b, int at, int n)
    {
        int w = Lane<V>.Width;
        int last = n >= Five ? Five : 0;
        for (int t = n - 1; t >= last; t--)
        {
            int row = diagonal + t * n * w;
            Lane<V> x = Lane<V>.Load(b, at + t * w) * Lane<V>.Load(a, row + t * w);
            x.Store(b, at + t * w);
            for (int i = 0; i < t * w; i += w)
            {
                (Lane<V>.Load(b, at + i) - Lane<V>.Load(a, row + i) * x).Store(b, at + i);
            }
        }

        if (n >= Five)
        {
            BackwardFive(a, diagonal, n * w, b, at);
        }
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void BackwardFive(double[] a, int g, int stride, double[] b, int at)
    {
        g += 4 * stride;
        Lane<V> x4 = Lane<V>.Load(b, at, 4) * Lane<V>.Load(a, g, 4);
        x4.Store(b, at, 4);
        Lane<V> x3 = Lane<V>.Load(b, at, 3) - x4 * Lane<V>.Load(a, g, 3);
        Lane<V> x2 = Lane<V>.Load(b, at, 2) - x4 * Lane<V>.Load(a, g, 2);
        Lane<V> x1 = Lane<V>.Load(b, at, 1) - x4 * Lane<V>.Load(a, g, 1);
        Lane<V> x0 = Lane<V>.Load(b, at) - x4 * Lane<V>.Load(a, g);
        g -= stride;
        x3 *= Lane<V>.Load(a, g, 3);
        x3.Store(b, at, 3);
        x2 -= x3 * Lane<V>.Load(a, g, 2);
        x1 -= x3 * Lane<V>.Load(a, g, 1);
        x0 -= x3 * Lane<V>.Load(a, g);
        g -= stride;
        x2 *= Lane<V>.Load(a, g, 2);
        x2.Store(b, at, 2);
        x1 -= x2 * Lane<V>.Load(a, g, 1);
        x0 -= x2 * Lane<V>.Load(a, g);
        g -= stride;
        x1 *= Lane<V>.Load(a, g, 1);
        x1.Store(b, at, 1);
        x0 -= x1 * Lane<V>.Load(a, g);
        (x0 * Lane<V>.Load(a, g - stride)).Store(b, at);
    }

    // C -= X Y^T, X m x n, Y k x n; for Triangle the lower triangle of C -= X X^T.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void SubtractProduct(double[] b, int c, int x, int m, double[] a, int y, int k, int n)
    {
        int w = Lane<V>.Width;
        int columns = k == Triangle ? m : k;
        for (int i = 0; i < m; i++, x += n * w, c += columns * w)
        {
            int end = c + (k == Triangle ? i + 1 : k) * w;
            int t = 0;
            if (n >= Five)
            {
                Lane<V> x0 = Lane<V>.Load(b, x), x1 = Lane<V>.Load(b, x, 1), x2 = Lane<V>.Load(b, x, 2);
                Lane<V> x3 = Lane<V>.Load(b, x, 3), x4 = Lane<V>.Load(b, x, 4);
                int row = y;
                for (int to = c; to < end; to += w, row += n * w)
                {
                    Lane<V> s = Lane<V>.Load(b, to);
                    s = s - x0 * Lane<V>.Load(a, row) - x1 * Lane<V>.Load(a, row, 1) - x2 * Lane<V>.Load(a, row, 2)
                        - x3 * Lane<V>.Load(a, row, 3) - x4 * Lane<V>.Load(a, row, 4);
                    s.Store(b, to);
                }

                t = Five;
            }

            for (; t < n; t++)
            {
                Lane<V> xt = Lane<V>.Load(b, x + t * w);
                int cell = y + t * w;
                for (int to = c; to < end; to += w, cell += n * w)
                {
                    (Lane<V>.Load(b, to) - xt * Lane<V>.Load(a, cell)).Store(b, to);
                }
            }
        }
    }

    // C += X Y^T, otherwise as above. Negative columns are few.
    private static void AddProduct(double[] a, int c, int x, int m, int y, int k, int n)
    {
        int w = Lane<V>.Width;
        int columns = k == Triangle ? m : k;
        for (int i = 0; i < m; i++, x += n * w, c += columns * w)
        {
            int end = k == Triangle ? i + 1 : k;
            for (int j = 0; j < end; j++)
            {
                Lane<V> s = Lane<V>.Load(a, c + j * w);
                for (int t = 0; t < n; t++)
                {
                    s += Lane<V>.Load(a, x + t * w) * Lane<V>.Load(a, y + (j * n + t) * w);
                }

                s.Store(a, c + j * w);
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
