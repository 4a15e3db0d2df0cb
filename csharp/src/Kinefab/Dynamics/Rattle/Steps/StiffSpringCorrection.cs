using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// A spring too stiff for the step spends its impulse before the drift (<see cref="ScalarRow.Theta"/> above 1/2). The half of the
/// other forces that acts after it meets no answer and leaves a speed of h F / 2 m, even of a body that stands still; the
/// next drift takes it up. What a step shows has that answer, -<see cref="SpringLaw.CorrectionGain"/> (v' - v) against the drift's speed v, with the rows
/// held; where the next step begins it is taken back, so that motion and account of energy are those of the impulses alone.
/// </summary>
internal sealed class StiffSpringCorrection
{
    // Of the solve, since the matrix's compliance leaves rows speed, see VelocityProjection.
    private const int Passes = 3;

    // Of the energy of motion, or of what forces give in the first steps from rest, the most that an answer may leave: more is none of the motion's.
    private const double MostShown = 4;

    private readonly Bodies _bodies;

    // The moving ones, in the world.
    private readonly int[] _members;

    // Of each moving body, without the answer, and as it is shown.
    private readonly Vector3d[] _linear;
    private readonly Vector3d[] _angular;
    private readonly Vector3d[] _shownLinear;
    private readonly Vector3d[] _shownAngular;
    private bool _isApplied;

    /// <param name="island">One with scalar rows.</param>
    /// <param name="bodies">The world's.</param>
    public StiffSpringCorrection(Island island, Bodies bodies)
    {
        _bodies = bodies;
        _members = island.Bodies;
        _linear = new Vector3d[island.MovingBodies];
        _angular = new Vector3d[island.MovingBodies];
        _shownLinear = new Vector3d[island.MovingBodies];
        _shownAngular = new Vector3d[island.MovingBodies];
    }

    /// <summary>Before a step is loaded. Velocities that were written since are those of the program that wrote them.</summary>
    public void Undo()
    {
        for (int body = 0; body < _linear.Length && _isApplied; body++)
        {
            int member = _members[body];
            if (_bodies.LinearVelocities[member] == _shownLinear[body] && _bodies.AngularVelocities[member] == _shownAngular[body])
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
        tape.Array(_shownLinear);
        tape.Array(_shownAngular);
        tape.Value(ref _isApplied);
    }

    /// <summary>Where a step ends, with the rows built there.</summary>
    /// <param name="batch">Of the island.</param>
    /// <param name="dt">Step, s.</param>
    public void Apply(LaneBatch<ScalarLane> batch, double dt)
    {
        ActiveSet<ScalarLane> scalars = batch.ActiveSet!;
        _isApplied = scalars.BeginCorrection();
        if (!_isApplied)
        {
            return;
        }

        LaneTransfer<ScalarLane>.EndStep(batch);
        Note(batch, _linear, _angular);
        Array.Copy(batch.Bodies, batch.Work.BodiesBefore, batch.Bodies.Length);
        double most = MostShown * EnergyAudit.MovingOf(batch, dt);
        bool hasAnswer = TryAnswer(batch, scalars, out bool isFinite);
        while (isFinite && scalars.TakeOutOverloaded(batch.Work.Move))
        {
            TakeBack(batch);
            hasAnswer = TryAnswer(batch, scalars, out isFinite);
        }

        if (!hasAnswer || !(EnergyAudit.KineticOf(batch) <= most))
        {
            TakeBack(batch);
        }

        scalars.EndCorrection();
        LaneTransfer<ScalarLane>.EndStep(batch);
        Note(batch, _shownLinear, _shownAngular);
    }

    private static void Note(LaneBatch<ScalarLane> batch, Vector3d[] linear, Vector3d[] angular)
    {
        for (int body = 0; body < linear.Length; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, 0);
            linear[body] = LaneTransfer<ScalarLane>.ReadVector(batch.Bodies, o + BodyLanes.V) + LaneTransfer<ScalarLane>.ReadVector(batch.Work.FrameVelocity, 0);
            angular[body] = LaneTransfer<ScalarLane>.ReadVector(batch.Bodies, o + BodyLanes.W);
        }
    }

    // Not by the opposite impulses: what an answer that ran away left would be its rounding.
    private static void TakeBack(LaneBatch<ScalarLane> batch) => Array.Copy(batch.Work.BodiesBefore, batch.Bodies, batch.Bodies.Length);

    // False where the rows leave it open, or where it runs away: what is left is more than there was.
    private static bool TryAnswer(LaneBatch<ScalarLane> batch, ActiveSet<ScalarLane> scalars, out bool isFinite)
    {
        double[] solution = batch.Work.Solution;
        double[] sum = batch.Work.Move;
        RattleStep<ScalarLane>.Factor(batch, false);
        batch.Work.Active[0] = 1;
        Array.Clear(sum, 0, sum.Length);
        isFinite = true;
        double first = double.PositiveInfinity;
        for (int pass = 0; ; pass++)
        {
            Impulses<ScalarLane>.NegativeSpeeds(batch);
            scalars.AddTargets();
            scalars.SubtractCorrections(sum);
            double left = DenseVector.Largest(solution);
            if (left > first || pass == Passes)
            {
                return !(left > first);
            }

            first = pass == 0 ? left : first;
            DelassusMatrix<ScalarLane>.Solve(batch, solution);
            isFinite = Finite.Is(DenseVector.Largest(solution));
            if (!isFinite)
            {
                return false;
            }

            Impulses<ScalarLane>.Apply(batch, solution);
            for (int i = 0; i < sum.Length; i++)
            {
                sum[i] += solution[i];
            }
        }
    }
}
