using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Numerics;
using MathNet.Numerics.LinearAlgebra;
using NUnit.Framework;

namespace Kinefab.Tests.Numerics;

/// <summary>Factor and solution of random block matrices, definite and quasi-definite, against a dense one, nodes without rows among them.</summary>
internal sealed class BlockCholeskyTests
{
    [Test]
    public void Solve_RandomBlocks_IsTheDenseSolution([Range(0, 99)] int seed)
    {
        var random = new Random(seed);
        int n = random.Next(2, 10);
        int[] sizes = Enumerable.Range(0, n).Select(_ => random.Next(0, 7)).ToArray();
        int positive = seed < 50 ? n : random.Next(0, n + 1);
        BlockPattern pattern = Pattern(random, sizes, positive, out List<(int A, int B)> couplings);
        Matrix<double> dense = Matrix<double>.Build.Dense(Math.Max(1, pattern.RowCount), Math.Max(1, pattern.RowCount));
        var matrix = new double[pattern.Length];
        foreach ((int a, int b) in couplings.Concat(Enumerable.Range(0, n).Select(i => (i, i))))
        {
            (int later, int earlier) = pattern.IsBefore(a, b) ? (b, a) : (a, b);
            int offset = a == b ? pattern.Diagonal(a) : pattern.Below(later, earlier);
            for (int i = 0; i < sizes[later]; i++)
            {
                for (int j = 0; j < (a == b ? i + 1 : sizes[earlier]); j++)
                {
                    double value = 2 * random.NextDouble() - 1 + (a == b && i == j ? a < positive ? 60 : -60 : 0);
                    matrix[offset + i * sizes[earlier] + j] = value;
                    (int row, int column) = (pattern.Rows[later] + i, pattern.Rows[earlier] + j);
                    dense[row, column] = dense[column, row] = value;
                }
            }
        }

        double[] right = Enumerable.Range(0, pattern.RowCount).Select(_ => random.NextDouble()).ToArray();
        double[] expected = pattern.RowCount == 0 ? [] : [.. dense.Solve(Vector<double>.Build.DenseOfArray(right))];

        BlockCholesky<ScalarLane>.Factor(pattern, matrix);
        BlockCholesky<ScalarLane>.Solve(pattern, matrix, right);

        Assert.That(right, Is.EqualTo(expected).Within(1e-12));
    }

    [Test]
    public void Refine_TinyPivots_LeavesNothing([Range(0, 19)] int seed)
    {
        // Rows of a compliance alone over one negative node: all but six repeat each other.
        var random = new Random(seed);
        const int Rows = 40;
        int[] sizes = [.. Enumerable.Repeat(1, Rows), 6];
        var pattern = new BlockPattern(sizes, Enumerable.Range(0, Rows).Select(row => (row, Rows)), Rows, new bool[Rows + 1]);
        var matrix = new double[pattern.Length];
        double[] right = new double[Rows + 6], motion = Enumerable.Range(0, 6).Select(_ => random.NextDouble()).ToArray();
        Matrix<double> dense = Matrix<double>.Build.Dense(Rows + 6, Rows + 6);
        for (int i = 0; i < Rows + 6; i++)
        {
            matrix[pattern.Diagonal(Math.Min(i, Rows)) + 7 * Math.Max(0, i - Rows)] = dense[i, i] = i < Rows ? 1e-8 : -1;
            for (int k = 0; k < 6 && i < Rows; k++)
            {
                double entry = random.NextDouble();
                matrix[(pattern.IsBefore(i, Rows) ? pattern.Below(Rows, i) : pattern.Below(i, Rows)) + k] = dense[i, Rows + k] = dense[Rows + k, i] = entry;
                right[i] += entry * motion[k];
            }
        }

        double[] factor = [.. matrix], solution = new double[Rows + 6];
        BlockCholesky<ScalarLane>.Factor(pattern, factor);
        IterativeRefinement<ScalarLane>.Solve(pattern, matrix, factor, [.. right], solution, new double[Rows + 6]);

        Vector<double> left = Vector<double>.Build.DenseOfArray(right) - dense * Vector<double>.Build.DenseOfArray(solution);
        Assert.That(left.InfinityNorm(), Is.LessThan(1e-13));
    }

    private static BlockPattern Pattern(Random random, int[] sizes, int positive, out List<(int A, int B)> couplings)
    {
        couplings = [];
        for (int a = 0; a < sizes.Length; a++)
            couplings.AddRange(Enumerable.Range(0, a).Where(_ => random.NextDouble() < 0.5).Select(b => (a, b)));
        return new BlockPattern(sizes, couplings, positive, sizes.Select(_ => random.Next(3) == 0).ToArray());
    }
}
