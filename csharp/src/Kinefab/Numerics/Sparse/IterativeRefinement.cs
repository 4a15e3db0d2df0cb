using System;

namespace Kinefab.Numerics;

/// <summary>
/// Solves A x = b with a factor that has lost digits, as one with small pivots has: x is corrected by the factor's answer to what it
/// leaves of b. Source: Wilkinson 1963; of quasi-definite matrices, Gill, Saunders and Shinnerl 1996.
/// </summary>
internal static class IterativeRefinement<V>
    where V : struct, ILane<V>
{
    // Each leaves of the error about what the factor left of the solution. A fixed number, so that no lane waits for another.
    private const int Corrections = 2;

    /// <summary>Finds x.</summary>
    /// <param name="pattern">Of both matrices.</param>
    /// <param name="matrix">A as it was assembled.</param>
    /// <param name="factor">Its factor by <see cref="BlockCholesky{V}"/>.</param>
    /// <param name="right">b; used up.</param>
    /// <param name="solution">Takes x.</param>
    /// <param name="correction">Room for as many rows.</param>
    public static void Solve(BlockPattern pattern, double[] matrix, double[] factor, double[] right, double[] solution, double[] correction)
    {
        int length = pattern.RowCount * Lane<V>.Width;
        Array.Clear(solution, 0, length);
        for (int i = 0; ; i++)
        {
            Array.Copy(right, correction, length);
            BlockCholesky<V>.Solve(pattern, factor, correction);
            for (int row = 0; row < length; row += Lane<V>.Width)
            {
                (Lane<V>.Load(solution, row) + Lane<V>.Load(correction, row)).Store(solution, row);
            }

            if (i == Corrections)
            {
                return;
            }

            SubtractProduct(pattern, matrix, correction, right);
        }
    }

    // b -= A x.
    private static void SubtractProduct(BlockPattern pattern, double[] a, double[] x, double[] b)
    {
        foreach (BlockPattern.Column column in pattern.Columns)
        {
            SubtractTriangle(a, column, x, b);
            foreach (BlockPattern.Block block in column.Below)
            {
                SubtractBlock(a, block, column, x, b);
            }
        }
    }

    private static void SubtractTriangle(double[] a, BlockPattern.Column column, double[] x, double[] b)
    {
        int w = Lane<V>.Width;
        for (int i = 0; i < column.Size; i++)
        {
            int row = (column.Row + i) * w;
            int cell = (column.Diagonal + i * column.Size) * w;
            Subtract(a, cell + i * w, x, row, b, row);
            for (int j = 0; j < i; j++)
            {
                Subtract(a, cell + j * w, x, (column.Row + j) * w, b, row);
                Subtract(a, cell + j * w, x, row, b, (column.Row + j) * w);
            }
        }
    }

    private static void SubtractBlock(double[] a, in BlockPattern.Block block, BlockPattern.Column column, double[] x, double[] b)
    {
        int w = Lane<V>.Width;
        for (int i = 0; i < block.Size; i++)
        {
            int row = (block.Row + i) * w;
            int cell = (block.Offset + i * column.Size) * w;
            for (int j = 0; j < column.Size; j++)
            {
                Subtract(a, cell + j * w, x, (column.Row + j) * w, b, row);
                Subtract(a, cell + j * w, x, row, b, (column.Row + j) * w);
            }
        }
    }

    private static void Subtract(double[] a, int cell, double[] x, int from, double[] b, int to) =>
        (Lane<V>.Load(b, to) - Lane<V>.Load(a, cell) * Lane<V>.Load(x, from)).Store(b, to);
}
