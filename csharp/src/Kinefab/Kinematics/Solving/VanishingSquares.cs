using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>Weights x of length 1 at which quadratic forms x' A x all vanish, found by Levenberg and Marquardt's method.</summary>
internal sealed class VanishingSquares
{
    // What the forms are to come to: where x stands in one by its square alone, x comes to the root of it.
    private const double Solved = 1e-10;

    // What they may come to: a pose that is closed to 1e-14 lies by the root of that beside the motions, where velocities are obstructed, and so do the
    // forms.
    private const double Known = 1e-7;
    private const int MaxIterations = 60;
    private const double FirstDamping = 1e-3;
    private const double LeastDamping = 1e-14;
    private const double MostDamping = 1e6;
    private const double DampingFactor = 10;

    // What has to be left of a start beside others.
    private const double LeastLength = 1e-6;

    private readonly List<double[,]> _forms;

    // Of a step's equations, which are dense.
    private readonly BlockPattern _pattern;

    /// <summary>Of symmetric matrices, one at least and all as large.</summary>
    public VanishingSquares(List<double[,]> forms)
    {
        _forms = forms;
        _pattern = new BlockPattern(new[] { forms[0].GetLength(0) }, Array.Empty<(int, int)>());
    }

    /// <summary>Weights near a start; null where that leads to none.</summary>
    /// <param name="start">Used up; of any length.</param>
    /// <param name="beside">Orthonormal; what is found is at right angles to these.</param>
    /// <param name="cancellation">Ends the search early, with an OperationCanceledException.</param>
    public double[]? Near(double[] start, IReadOnlyList<double[]> beside, CancellationToken cancellation)
    {
        double[] weights = start;
        if (!Normalise(weights, beside))
        {
            return null;
        }

        double[] values = Values(weights, out double[][] slopes);
        double damping = FirstDamping;
        for (int n = 0; n < MaxIterations && damping < MostDamping && DenseVector.Largest(values) > Solved; n++)
        {
            cancellation.ThrowIfCancellationRequested();
            double[] there = Stepped(weights, values, slopes, beside, damping);
            if (Normalise(there, beside))
            {
                double[] now = Values(there, out double[][] its);
                if (DenseVector.Dot(now, now) < DenseVector.Dot(values, values))
                {
                    (weights, values, slopes) = (there, now, its);
                    damping = Math.Max(LeastDamping, damping / DampingFactor);
                    continue;
                }
            }

            damping *= DampingFactor;
        }

        return DenseVector.Largest(values) <= Known ? weights : null;
    }

    // Takes out of weights what they have along others, and makes them 1 long; false where nothing is left.
    private static bool Normalise(double[] weights, IReadOnlyList<double[]> beside)
    {
        double before = DenseVector.Length(weights);
        foreach (double[] other in beside)
        {
            DenseVector.RemoveAlong(weights, other);
        }

        double length = DenseVector.Length(weights);
        if (!(length > LeastLength * before))
        {
            return false;
        }

        DenseVector.Divide(weights, length);
        return true;
    }

    // The forms, and how each changes with the weights.
    private double[] Values(double[] weights, out double[][] slopes)
    {
        int n = weights.Length;
        var values = new double[_forms.Count];
        slopes = new double[_forms.Count][];
        for (int f = 0; f < values.Length; f++)
        {
            double[,] form = _forms[f];
            var slope = new double[n];
            for (int i = 0; i < n; i++)
            {
                double sum = 0;
                for (int j = 0; j < n; j++)
                {
                    sum += form[i, j] * weights[j];
                }

                slope[i] = 2 * sum;
                values[f] += sum * weights[i];
            }

            slopes[f] = slope;
        }

        return values;
    }

    // A damped least-squares step, along the sphere and at right angles to others.
    private double[] Stepped(double[] weights, double[] values, double[][] slopes, IReadOnlyList<double[]> beside, double damping)
    {
        int n = weights.Length;
        var normal = new double[_pattern.Length];
        var right = new double[n];
        for (int f = 0; f < slopes.Length; f++)
        {
            var slope = (double[])slopes[f].Clone();
            DenseVector.RemoveAlong(slope, weights);
            foreach (double[] other in beside)
            {
                DenseVector.RemoveAlong(slope, other);
            }

            DenseVector.Add(right, -values[f], slope);
            for (int i = 0; i < n; i++)
            {
                for (int j = 0; slope[i] != 0 && j <= i; j++)
                {
                    normal[i * n + j] += slope[i] * slope[j];
                }
            }
        }

        for (int i = 0; i < n; i++)
        {
            normal[i * n + i] += damping;
        }

        BlockCholesky<ScalarLane>.Factor(_pattern, normal);
        BlockCholesky<ScalarLane>.Solve(_pattern, normal, right);
        DenseVector.Add(right, 1, weights);
        return right;
    }
}
