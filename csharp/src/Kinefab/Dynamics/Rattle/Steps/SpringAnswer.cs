using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

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
    private readonly Bodies _bodies;

    // Of each moving body, without the answer.
    private readonly Vector3d[] _linear;
    private readonly Vector3d[] _angular;
    private bool _isGiven;

    /// <param name="batch">Of an island with laws.</param>
    /// <param name="bodies">The world's.</param>
    public SpringAnswer(Batch<ScalarLane> batch, Bodies bodies)
    {
        _batch = batch;
        _bodies = bodies;
        _linear = new Vector3d[batch.Shape.MovingBodies];
        _angular = new Vector3d[batch.Shape.MovingBodies];
    }

    /// <summary>Before a step is loaded. Velocities that were written since are those of the program that wrote them.</summary>
    public void TakeBack()
    {
        double[] a = _batch.Bodies;
        for (int body = 0; body < _linear.Length && _isGiven; body++)
        {
            int o = Batch<ScalarLane>.Body(body, 0);
            int member = _batch.Members[body];
            if (_bodies.LinearVelocities[member] == Transfer<ScalarLane>.Vector(a, o + BodySlot.V)
                && _bodies.AngularVelocities[member] == Transfer<ScalarLane>.Vector(a, o + BodySlot.W))
            {
                _bodies.LinearVelocities[member] = _linear[body];
                _bodies.AngularVelocities[member] = _angular[body];
            }
        }

        _isGiven = false;
    }

    /// <summary>What the next step takes from those before it.</summary>
    public void Exchange(StateTape tape)
    {
        tape.Array(_linear);
        tape.Array(_angular);
        tape.Value(ref _isGiven);
    }

    /// <summary>Where a step ends, with the rows built there.</summary>
    public void Give()
    {
        Laws<ScalarLane> laws = _batch.Laws!;
        _isGiven = laws.BeginAnswer();
        if (!_isGiven)
        {
            return;
        }

        Transfer<ScalarLane>.Finish(_batch);
        for (int body = 0; body < _linear.Length; body++)
        {
            int o = Batch<ScalarLane>.Body(body, 0);
            _linear[body] = Transfer<ScalarLane>.Vector(_batch.Bodies, o + BodySlot.V);
            _angular[body] = Transfer<ScalarLane>.Vector(_batch.Bodies, o + BodySlot.W);
        }

        double[] solution = _batch.Work.Solution;
        double[] sum = _batch.Work.Move;
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

        laws.EndAnswer();
    }
}
