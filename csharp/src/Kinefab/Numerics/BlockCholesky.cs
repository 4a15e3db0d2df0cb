namespace Kinefab.Numerics;

/// <summary>
/// A = G G^T in place for symmetric positive definite block-sparse matrices of one pattern, several at a time in lanes.
/// Number i of the pattern stands at i * width in the array. The factor's diagonal is stored inverted.
/// </summary>
internal static class BlockCholesky<V>
    where V : struct, ILane<V>
{
    // A pivot lost to rounding is replaced, so that the result stays finite; the caller's residual then tells.
    private const double LeastPivot = 1e-30;

    /// <summary>Replaces the matrix by its factor.</summary>
    public static void Factor(BlockPattern pattern, double[] a)
    {
        foreach (BlockPattern.Column column in pattern.Columns)
        {
            int n = column.Size;
            FactorDiagonal(a, column.Diagonal, n);
            BlockPattern.Block[] below = column.Below;
            int product = 0;
            for (int i = 0; i < below.Length; i++)
            {
                SolveRight(a, below[i].Offset, column.Diagonal, below[i].Size, n);
                for (int k = 0; k < i; k++)
                {
                    SubtractProduct(a, column.Products[product++], below[i].Offset, below[k].Offset, below[i].Size, below[k].Size, n);
                }

                SubtractSquare(a, column.Products[product++], below[i].Offset, below[i].Size, n);
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
            int n = column.Size;
            for (int i = 0; i < n; i++)
            {
                int row = column.Diagonal + i * n;
                Lane<V> s = Lane<V>.Load(b, (column.Row + i) * w);
                for (int t = 0; t < i; t++)
                {
                    s -= Lane<V>.Load(a, (row + t) * w) * Lane<V>.Load(b, (column.Row + t) * w);
                }

                (s * Lane<V>.Load(a, (row + i) * w)).Store(b, (column.Row + i) * w);
            }

            foreach (BlockPattern.Block block in column.Below)
            {
                for (int i = 0; i < block.Size; i++)
                {
                    int row = block.Offset + i * n;
                    Lane<V> s = Lane<V>.Load(b, (block.Row + i) * w);
                    for (int t = 0; t < n; t++)
                    {
                        s -= Lane<V>.Load(a, (row + t) * w) * Lane<V>.Load(b, (column.Row + t) * w);
                    }

                    s.Store(b, (block.Row + i) * w);
                }
            }
        }

        for (int turn = columns.Length - 1; turn >= 0; turn--)
        {
            BlockPattern.Column column = columns[turn];
            int n = column.Size;
            for (int i = n - 1; i >= 0; i--)
            {
                Lane<V> s = Lane<V>.Load(b, (column.Row + i) * w);
                foreach (BlockPattern.Block block in column.Below)
                {
                    for (int t = 0; t < block.Size; t++)
                    {
                        s -= Lane<V>.Load(a, (block.Offset + t * n + i) * w) * Lane<V>.Load(b, (block.Row + t) * w);
                    }
                }

                for (int t = i + 1; t < n; t++)
                {
                    s -= Lane<V>.Load(a, (column.Diagonal + t * n + i) * w) * Lane<V>.Load(b, (column.Row + t) * w);
                }

                (s * Lane<V>.Load(a, (column.Diagonal + i * n + i) * w)).Store(b, (column.Row + i) * w);
            }
        }
    }

    private static void FactorDiagonal(double[] a, int offset, int n)
    {
        int w = Lane<V>.Width;
        Lane<V> one = Lane<V>.Splat(1);
        Lane<V> least = Lane<V>.Splat(LeastPivot);
        for (int i = 0; i < n; i++)
        {
            int row = offset + i * n;
            for (int j = 0; j < i; j++)
            {
                int other = offset + j * n;
                Lane<V> s = Lane<V>.Load(a, (row + j) * w);
                for (int t = 0; t < j; t++)
                {
                    s -= Lane<V>.Load(a, (row + t) * w) * Lane<V>.Load(a, (other + t) * w);
                }

                (s * Lane<V>.Load(a, (other + j) * w)).Store(a, (row + j) * w);
            }

            Lane<V> pivot = Lane<V>.Load(a, (row + i) * w);
            for (int t = 0; t < i; t++)
            {
                Lane<V> g = Lane<V>.Load(a, (row + t) * w);
                pivot -= g * g;
            }

            (one / Lane<V>.Sqrt(Lane<V>.Max(pivot, least))).Store(a, (row + i) * w);
        }
    }

    // X G^T = B, B (m x n) replaced by X.
    private static void SolveRight(double[] a, int block, int diagonal, int m, int n)
    {
        int w = Lane<V>.Width;
        for (int i = 0; i < m; i++)
        {
            int row = block + i * n;
            for (int j = 0; j < n; j++)
            {
                int other = diagonal + j * n;
                Lane<V> s = Lane<V>.Load(a, (row + j) * w);
                for (int t = 0; t < j; t++)
                {
                    s -= Lane<V>.Load(a, (row + t) * w) * Lane<V>.Load(a, (other + t) * w);
                }

                (s * Lane<V>.Load(a, (other + j) * w)).Store(a, (row + j) * w);
            }
        }
    }

    // C -= X Y^T, X m x n, Y k x n.
    private static void SubtractProduct(double[] a, int c, int x, int y, int m, int k, int n)
    {
        int w = Lane<V>.Width;
        for (int i = 0; i < m; i++)
        {
            for (int j = 0; j < k; j++)
            {
                Lane<V> s = Lane<V>.Load(a, (c + i * k + j) * w);
                for (int t = 0; t < n; t++)
                {
                    s -= Lane<V>.Load(a, (x + i * n + t) * w) * Lane<V>.Load(a, (y + j * n + t) * w);
                }

                s.Store(a, (c + i * k + j) * w);
            }
        }
    }

    // Lower triangle of C -= X X^T, X m x n.
    private static void SubtractSquare(double[] a, int c, int x, int m, int n)
    {
        int w = Lane<V>.Width;
        for (int i = 0; i < m; i++)
        {
            for (int j = 0; j <= i; j++)
            {
                Lane<V> s = Lane<V>.Load(a, (c + i * m + j) * w);
                for (int t = 0; t < n; t++)
                {
                    s -= Lane<V>.Load(a, (x + i * n + t) * w) * Lane<V>.Load(a, (x + j * n + t) * w);
                }

                s.Store(a, (c + i * m + j) * w);
            }
        }
    }
}
