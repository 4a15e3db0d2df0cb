using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Numerics;
using MathNet.Numerics.LinearAlgebra;
using NUnit.Framework;

namespace Kinefab.Tests.Numerics;

/// <summary>Factor and solution of random block matrices against a dense one, nodes without rows among them.</summary>
internal sealed class BlockCholeskyTests
{
    [Test]
    public void Solve_RandomBlocks_IsTheDenseSolution([Range(0, 49)] int seed)
    {
        var random = new Random(seed);
        int n = random.Next(2, 10);
        int[] sizes = Enumerable.Range(0, n).Select(_ => random.Next(0, 7)).ToArray();
        var couplings = new List<(int A, int B)>();
        for (int a = 0; a < n; a++)
            couplings.AddRange(Enumerable.Range(0, a).Where(_ => random.NextDouble() < 0.5).Select(b => (a, b)));
        var pattern = new BlockPattern(sizes, couplings);
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
                    double value = 2 * random.NextDouble() - 1 + (a == b && i == j ? 60 : 0);
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
}
