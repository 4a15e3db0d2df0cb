using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>
/// A spring too stiff for the step spends its impulse before the flight (<see cref="Law.Theta"/> above 1/2). The half of the
/// other forces that acts after it meets no answer and leaves a speed of h F / 2 m, even of a body that stands still; the
/// next flight takes it up. What a step shows has that answer, -Grip (v' - v) against the flight's speed v, with the rows
/// held; where the next step begins it is taken back, so that motion and account of energy are those of the impulses alone.
/// </summary>
internal sealed class SpringAnswer
{
    // Of the solve, since the matrix's compliance leaves rows speed, see VelocityProjection.
    private const int Passes = 3;

    private readonly Batch<ScalarLane> _batch;

    // Velocities and angular momenta of each moving body: without the answer, then what it changed.
    private readonly double[] _change;
    private bool _isGiven;

    public SpringAnswer(Batch<ScalarLane> batch)
    {
        _batch = batch;
        _change = new double[6 * batch.Shape.MovingBodies];
    }

    /// <summary>Where a step begins, its momenta damped; with a pose that was moved since, the answer is none.</summary>
    public void TakeBack(bool isMoved)
    {
        double[] a = _batch.Bodies;
        for (int body = 0; body < _batch.Shape.MovingBodies && _isGiven && !isMoved; body++)
        {
            int o = Batch<ScalarLane>.Body(body, 0);
            for (int i = 0; i < 6; i++)
            {
                a[o + BodySlot.V + i] -= a[o + BodySlot.Kept + i / 3] * _change[6 * body + i];
            }
        }

        _isGiven = false;
    }

    /// <summary>Where a step ends, with the rows built there.</summary>
    public void Give(Laws<ScalarLane> laws)
    {
        _isGiven = laws.BeginAnswer();
        if (!_isGiven)
        {
            return;
        }

        double[] solution = _batch.Work.Solution;
        double[] sum = _batch.Work.Move;
        Read(true);
        RattleStep<ScalarLane>.Factor(_batch, false);
        _batch.Work.Active[0] = 1;
        Array.Clear(sum, 0, sum.Length);
        for (int pass = 0; pass < Passes; pass++)
        {
            Impulses<ScalarLane>.NegativeSpeeds(_batch);
            laws.AddTargets();
            laws.TakeAnswers(sum);
            BlockCholesky<ScalarLane>.Solve(_batch.Shape.Pattern, _batch.Matrix, solution);
            Impulses<ScalarLane>.Apply(_batch, solution);
            for (int i = 0; i < sum.Length; i++)
            {
                sum[i] += solution[i];
            }
        }

        Read(false);
        laws.EndAnswer();
    }

    // The momenta, or what became of them since.
    private void Read(bool isBefore)
    {
        double[] a = _batch.Bodies;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = Batch<ScalarLane>.Body(body, BodySlot.V);
            for (int i = 0; i < 6; i++)
            {
                _change[6 * body + i] = a[o + i] - (isBefore ? 0 : _change[6 * body + i]);
            }
        }
    }
}
