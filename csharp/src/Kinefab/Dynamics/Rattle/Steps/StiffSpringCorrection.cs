using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// A spring too stiff for the step spends its impulse before the drift (<see cref="ScalarRow.Theta"/> above 1/2). The half of the
/// other forces that acts after it meets no answer and leaves a speed of h F / 2 m, even of a body that stands still; the
/// next drift takes it up. What a step shows has that answer, -Grip (v' - v) against the drift's speed v, with the rows
/// held; where the next step begins it is taken back, so that motion and account of energy are those of the impulses alone.
/// </summary>
internal sealed class StiffSpringCorrection
{
    // Of the solve, since the matrix's compliance leaves rows speed, see VelocityProjection.
    private const int Passes = 3;

    private readonly LaneBatch<ScalarLane> _batch;
    private readonly Bodies _bodies;

    // Of each moving body, without the answer.
    private readonly Vector3d[] _linear;
    private readonly Vector3d[] _angular;
    private bool _isApplied;

    /// <param name="batch">Of an island with scalar rows.</param>
    /// <param name="bodies">The world's.</param>
    public StiffSpringCorrection(LaneBatch<ScalarLane> batch, Bodies bodies)
    {
        _batch = batch;
        _bodies = bodies;
        _linear = new Vector3d[batch.Shape.MovingBodies];
        _angular = new Vector3d[batch.Shape.MovingBodies];
    }

    /// <summary>Before a step is loaded. Velocities that were written since are those of the program that wrote them.</summary>
    public void Undo()
    {
        double[] a = _batch.Bodies;
        for (int body = 0; body < _linear.Length && _isApplied; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, 0);
            int member = _batch.Members[body];
            if (_bodies.LinearVelocities[member] == LaneTransfer<ScalarLane>.ReadVector(a, o + BodyLanes.V)
                && _bodies.AngularVelocities[member] == LaneTransfer<ScalarLane>.ReadVector(a, o + BodyLanes.W))
            {
                _bodies.LinearVelocities[member] = _linear[body];
                _bodies.AngularVelocities[member] = _angular[body];
            }
        }

        _isApplied = false;
    }

    /// <summary>What the next step takes from those before it.</summary>
    public void Exchange(StateTape tape)
    {
        tape.Array(_linear);
        tape.Array(_angular);
        tape.Value(ref _isApplied);
    }

    /// <summary>Where a step ends, with the rows built there.</summary>
    public void Apply()
    {
        ActiveSet<ScalarLane> scalars = _batch.ActiveSet!;
        _isApplied = scalars.BeginCorrection();
        if (!_isApplied)
        {
            return;
        }

        LaneTransfer<ScalarLane>.EndStep(_batch);
        for (int body = 0; body < _linear.Length; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, 0);
            _linear[body] = LaneTransfer<ScalarLane>.ReadVector(_batch.Bodies, o + BodyLanes.V);
            _angular[body] = LaneTransfer<ScalarLane>.ReadVector(_batch.Bodies, o + BodyLanes.W);
        }

        bool hasAnswer = TryAnswer(scalars);
        while (hasAnswer && scalars.TakeOutOverloaded(_batch.Work.Move))
        {
            TakeBack();
            hasAnswer = TryAnswer(scalars);
        }

        if (!hasAnswer)
        {
            TakeBack();
        }

        scalars.EndCorrection();
    }

    private void TakeBack()
    {
        double[] solution = _batch.Work.Solution;
        for (int i = 0; i < solution.Length; i++)
        {
            solution[i] = -_batch.Work.Move[i];
        }

        Impulses<ScalarLane>.Apply(_batch, solution);
    }

    // False where the rows leave it open; what was applied by then is finite.
    private bool TryAnswer(ActiveSet<ScalarLane> scalars)
    {
        double[] solution = _batch.Work.Solution;
        double[] sum = _batch.Work.Move;
        RattleStep<ScalarLane>.Factor(_batch, false);
        _batch.Work.Active[0] = 1;
        Array.Clear(sum, 0, sum.Length);
        for (int pass = 0; pass < Passes; pass++)
        {
            Impulses<ScalarLane>.NegativeSpeeds(_batch);
            scalars.AddTargets();
            scalars.SubtractCorrections(sum);
            DelassusMatrix<ScalarLane>.Solve(_batch, solution);
            foreach (double impulse in solution)
            {
                if (!Finite.Is(impulse))
                {
                    return false;
                }
            }

            Impulses<ScalarLane>.Apply(_batch, solution);
            for (int i = 0; i < sum.Length; i++)
            {
                sum[i] += solution[i];
            }
        }

        return true;
    }
}
