using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Solves J M^-1 J^T d = b to the rows' own response on the only lane, with the factored matrix, whose compliance keeps repeated rows
/// apart, as preconditioner: each mode that the compliance hides, as of a slender body beside a heavy one in a loop, costs an iteration,
/// where the chord alone would take hundreds. Source: Hestenes and Stiefel 1952.
/// </summary>
internal sealed class ConjugateGradient
{
    private const int MaxIterations = 30;

    // Share of the residual's square, in the preconditioner's norm, that is left.
    private const double MostLeft = 1e-20;

    // Share of the preconditioner's response below which a direction is rounding: of rows that repeat or contradict each other.
    private const double LeastCurvature = 1e-8;

    private readonly LaneBatch<ScalarLane> _batch;
    private readonly double[] _sum;

    // The sum with the least residual so far.
    private readonly double[] _best;
    private readonly double[] _residual;
    private readonly double[] _direction;

    // Velocities and angular momenta of the bodies, while those of the direction stand in their place.
    private readonly double[] _momenta;

    public ConjugateGradient(LaneBatch<ScalarLane> batch)
    {
        _batch = batch;
        _sum = new double[batch.Shape.RowCount];
        _best = new double[_sum.Length];
        _residual = new double[_sum.Length];
        _direction = new double[_sum.Length];
        _momenta = new double[6 * batch.Shape.MovingBodies];
    }

    /// <summary>The right-hand side stands in Work.Solution, and so does the result.</summary>
    /// <param name="isDrift">See <see cref="ActiveSet{V}.AddToDiagonal"/>.</param>
    public void Solve(bool isDrift)
    {
        double[] solution = _batch.Work.Solution;
        _batch.ActiveSet?.ClearAtBound(solution);
        Array.Copy(solution, _residual, solution.Length);
        Array.Clear(_sum, 0, _sum.Length);
        Array.Clear(_best, 0, _best.Length);
        DelassusMatrix<ScalarLane>.Solve(_batch, solution);
        Array.Copy(solution, _direction, solution.Length);
        double square = DenseVector.Dot(_residual, solution);
        double norm = square;
        double enough = MostLeft * square;
        double least = double.PositiveInfinity;
        SwapMomenta();
        for (int iteration = 0; iteration < MaxIterations && square > enough; iteration++)
        {
            Multiply(_direction, isDrift);
            double curvature = DenseVector.Dot(_direction, solution);
            if (!(curvature > LeastCurvature * norm))
            {
                if (iteration == 0)
                {
                    // Of nothing but such rows: what the compliance makes of them.
                    Array.Copy(_direction, _best, _best.Length);
                }

                break;
            }

            double length = square / curvature;
            for (int i = 0; i < solution.Length; i++)
            {
                _sum[i] += length * _direction[i];
                _residual[i] -= length * solution[i];
            }

            Array.Copy(_residual, solution, solution.Length);
            DelassusMatrix<ScalarLane>.Solve(_batch, solution);
            double next = DenseVector.Dot(_residual, solution);
            if (next < least)
            {
                // What follows may be rounding: of a tiny body, whose turns answer a thousand times as much as its ways, even where its curvature is more.
                least = next;
                Array.Copy(_sum, _best, _best.Length);
            }

            for (int i = 0; i < solution.Length; i++)
            {
                _direction[i] = solution[i] + next / square * _direction[i];
            }

            norm = next + next / square * (next / square) * norm;
            square = next;
        }

        SwapMomenta();
        Array.Copy(_best, solution, solution.Length);
    }

    /// <summary>What the rows of the drift's matrix answer to impulses, into Work.Solution.</summary>
    /// <param name="impulses">0 at rows that are at their bound.</param>
    public void RespondInDrift(double[] impulses)
    {
        SwapMomenta();
        Multiply(impulses, isDrift: true);
        SwapMomenta();
    }

    // Work.Solution = J M^-1 J^T p, by the momenta that p gives.
    private void Multiply(double[] p, bool isDrift)
    {
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            Array.Clear(_batch.Bodies, LaneBatch<ScalarLane>.Body(body, BodyLanes.V), 6);
        }

        _batch.Work.Active[0] = 1;
        Impulses<ScalarLane>.Apply(_batch, p);
        Impulses<ScalarLane>.NegativeSpeeds(_batch, false);
        for (int i = 0; i < p.Length; i++)
        {
            _batch.Work.Solution[i] = -_batch.Work.Solution[i];
        }

        _batch.ActiveSet?.AddCompliance(p, _batch.Work.Solution, isDrift);
    }

    private void SwapMomenta()
    {
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, BodyLanes.V);
            for (int i = 0; i < 6; i++)
            {
                (_batch.Bodies[o + i], _momenta[6 * body + i]) = (_momenta[6 * body + i], _batch.Bodies[o + i]);
            }
        }
    }
}
