using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Which velocities of a pose the joints' second derivatives leave. A motion with the velocity v and the acceleration a keeps the rows to second
/// order where J a + h(v, v) = 0, h the curvature of the rows: so what h(v, v) has beside all that accelerations make has to vanish. That is a
/// few squares in the velocities' weights alone, however large the linkage, and what no motion has fails it before a step is taken. Source:
/// Connelly and Whiteley 1996, second-order rigidity.
/// </summary>
internal sealed class SecondOrder
{
    // Of the steps that the rows' curvature is taken by, and what of it is their rounding and their own curvature.
    private const double Step = 1e-4;
    private const double Straight = 1e-6;

    // What of a row's curvature is none, and of a share.
    private const double Rounding = 1e-10;

    // Of the mixtures by which it is seen that nothing is curved: of those that are, one in a great many looks straight in a mixture.
    private const int Mixtures = 2;

    // What accelerations make is taken out so many times, with this damping.
    private const int Refinements = 2;
    private const double Damping = 1e-12;

    // Mixtures tried one after another that lead nowhere, as many do where branches are many: then there is nothing more to find.
    private const int Spare = 16;

    private readonly VelocitySpace _space;
    private readonly CancellationToken _cancellation;
    private VanishingSquares? _curved;

    /// <summary>Of a closed state.</summary>
    public SecondOrder(NewtonSolver newton, VelocitySpace space, MechanismState state, CancellationToken cancellation)
    {
        _space = space;
        _cancellation = cancellation;
        MechanismState moved = state.Clone();
        if (space.Freedoms > 0 && !LooksStraight(newton, state, moved))
        {
            Collect(newton, state, moved);
        }
    }

    /// <summary>
    /// Orthonormal velocities that second order leaves: all of the pose where it does, else found one by one, each beside those before it. Where
    /// one branch of motions passes through the pose, its motions are among what they span.
    /// </summary>
    public IReadOnlyList<double[]> Basis()
    {
        if (_curved is null)
        {
            return _space.Basis;
        }

        var known = new List<double[]>();
        for (int round = 0, missed = 0; missed < Spare && known.Count < _space.Freedoms; round++)
        {
            double[]? weights = _curved.Near(Start(round), known, _cancellation);
            missed = weights is null ? missed + 1 : 0;
            if (weights is not null)
            {
                known.Add(weights);
            }
        }

        return known.ConvertAll(Velocity);
    }

    /// <summary>A step along a velocity that second order leaves, near a mixture of all; zero where it leaves none.</summary>
    /// <param name="round">Another one for each.</param>
    /// <param name="length">Of its largest entry, radians or lengths.</param>
    public double[] Mixture(int round, double length)
    {
        if (_curved is null)
        {
            return _space.Mixture(round, length);
        }

        double[]? weights = null;
        for (int n = 0; n < Spare && weights is null; n++)
        {
            weights = _curved.Near(Start(round + n), new List<double[]>(), _cancellation);
        }

        double[] step = weights is null ? new double[_space.Basis[0].Length] : Velocity(weights);
        double largest = DenseVector.Largest(step);
        if (largest > 0)
        {
            DenseVector.Divide(step, largest / length);
        }

        return step;
    }

    private double[] Start(int round)
    {
        var weights = new double[_space.Freedoms];
        for (int k = 0; k < weights.Length; k++)
        {
            weights[k] = VelocitySpace.Weight(k, round);
        }

        return weights;
    }

    private double[] Velocity(double[] weights)
    {
        var velocity = new double[_space.Basis[0].Length];
        for (int k = 0; k < weights.Length; k++)
        {
            DenseVector.Add(velocity, weights[k], _space.Basis[k]);
        }

        return velocity;
    }

    private bool LooksStraight(NewtonSolver newton, MechanismState state, MechanismState moved)
    {
        for (int round = 0; round < Mixtures; round++)
        {
            double[] velocity = _space.Mixture(round, 1);
            double[] curvature = Rates(newton, state, moved, velocity, new[] { velocity }).ConvertAll(rates => rates[0]).ToArray();
            newton.Factor(_space.Rows, Damping);
            TakeAccelerationsOut(newton, curvature);
            if (DenseVector.Largest(curvature) > Straight)
            {
                return false;
            }
        }

        return true;
    }

    // For each row how the way along one velocity changes what others change the row by.
    private static List<double[]> Rates(NewtonSolver newton, MechanismState state, MechanismState moved, double[] along, IReadOnlyList<double[]> velocities)
    {
        PackedRows there = At(Step);
        PackedRows back = At(-Step);
        var rates = new List<double[]>();
        for (int r = 0; r < there.Count; r++)
        {
            int[] columns = there.Columns(r);
            var change = (double[])there.Row(r).Clone();
            DenseVector.Add(change, -1, back.Row(r));
            DenseVector.Divide(change, 2 * Step);
            var rate = new double[velocities.Count];
            for (int v = 0; v < rate.Length; v++)
            {
                for (int i = 0; i < columns.Length; i++)
                {
                    rate[v] += change[i] * velocities[v][columns[i]];
                }
            }

            rates.Add(rate);
        }

        return rates;

        PackedRows At(double length)
        {
            moved.CopyFrom(state);
            double[] step = Array.ConvertAll(along, entry => length * entry);
            newton.Motion.Start(moved.Poses);
            newton.Motion.Move(moved.Poses, step);
            return newton.Rows(moved);
        }
    }

    // What a sum of the rows has beside all that accelerations make of them.
    private void TakeAccelerationsOut(NewtonSolver newton, double[] numbers)
    {
        for (int n = 0; n < Refinements; n++)
        {
            DenseVector.Add(numbers, 1, _space.Rows.Times(newton.Answer(_space.Rows, numbers)));
        }
    }

    // A matrix in the velocities' weights for each row that is curved beside what accelerations make.
    private void Collect(NewtonSolver newton, MechanismState state, MechanismState moved)
    {
        int n = _space.Freedoms;
        var curvatures = new double[_space.Rows.Count][,];
        for (int r = 0; r < curvatures.Length; r++)
        {
            curvatures[r] = new double[n, n];
        }

        for (int i = 0; i < n; i++)
        {
            _cancellation.ThrowIfCancellationRequested();
            List<double[]> rates = Rates(newton, state, moved, _space.Basis[i], _space.Basis);
            for (int r = 0; r < curvatures.Length; r++)
            {
                for (int j = 0; j < n; j++)
                {
                    curvatures[r][i, j] += rates[r][j] / 2;
                    curvatures[r][j, i] += rates[r][j] / 2;
                }
            }
        }

        var left = new double[curvatures.Length][,];
        newton.Factor(_space.Rows, Damping);
        for (int r = 0; r < curvatures.Length; r++)
        {
            if (Largest(curvatures[r]) <= Rounding)
            {
                continue;
            }

            _cancellation.ThrowIfCancellationRequested();
            var share = new double[curvatures.Length];
            share[r] = 1;
            TakeAccelerationsOut(newton, share);
            for (int to = 0; to < share.Length; to++)
            {
                if (Math.Abs(share[to]) > Rounding)
                {
                    Add(left[to] ??= new double[n, n], share[to], curvatures[r]);
                }
            }
        }

        List<double[,]> curved = new List<double[,]>(left).FindAll(matrix => matrix is not null && Largest(matrix) > Straight);
        _curved = curved.Count == 0 ? null : new VanishingSquares(curved);
    }

    private static void Add(double[,] sum, double share, double[,] matrix)
    {
        for (int i = 0; i < sum.GetLength(0); i++)
        {
            for (int j = 0; j < sum.GetLength(1); j++)
            {
                sum[i, j] += share * matrix[i, j];
            }
        }
    }

    private static double Largest(double[,] matrix)
    {
        double largest = 0;
        foreach (double entry in matrix)
        {
            largest = Math.Max(largest, Math.Abs(entry));
        }

        return largest;
    }
}
