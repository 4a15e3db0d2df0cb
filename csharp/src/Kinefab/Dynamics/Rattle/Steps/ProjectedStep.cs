using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The last resort, which always finds a motion where one exists: velocities at the start pose that all rows allow (Moreau's and Anitescu's
/// time stepping: a linear complementarity problem, springs implicit), the drift by them, and the end pose closed by position alone with
/// its rows built anew in each iteration. Of first order and dissipative but for what closing the pose gives.
/// Sources: Moreau 1988; Anitescu and Potra 1997.
/// </summary>
internal sealed class ProjectedStep
{
    private readonly LaneBatch<ScalarLane> _batch;
    private readonly PositionProjection _closure;
    private readonly ConjugateGradient _conjugateGradient;

    public ProjectedStep(LaneBatch<ScalarLane> batch, ConjugateGradient conjugateGradient)
    {
        _batch = batch;
        _closure = new PositionProjection(batch, conjugateGradient);
        _conjugateGradient = conjugateGradient;
    }

    /// <summary>From the start pose to a closed end pose with momenta that are tangent to it; false when it does not close.</summary>
    public bool TrySolve(double h, double tolerance)
    {
        LaneBatch<ScalarLane> batch = _batch;
        ActiveSet<ScalarLane>? scalars = batch.ActiveSet;
        batch.Work.Active[0] = 1;
        CompliantAngles<ScalarLane>.Begin(batch, h);
        scalars?.Begin(h, tolerance, true);
        RattleStep<ScalarLane>.Kick(batch, h);
        Array.Clear(batch.Work.PositionImpulses, 0, batch.Work.PositionImpulses.Length);
        Array.Clear(batch.VelocityImpulses, 0, batch.VelocityImpulses.Length);
        scalars?.ClearFree();
        Impulses<ScalarLane>.Apply(batch, batch.Work.PositionImpulses);
        FindVelocities(h);
        FreeMotion<ScalarLane>.DriftKinematic(batch, h);
        LockedInertiaAxes<ScalarLane>.ClearMomentum(batch);
        FreeMotion<ScalarLane>.Drift(batch, h);
        BilateralRows<ScalarLane>.Evaluate(batch);
        CompliantAngles<ScalarLane>.Evaluate(batch);
        scalars?.AddWork();
        CompliantAngles<ScalarLane>.AddDrift(batch);

        // Closing the pose would make rotations of what is none.
        if (!FreeMotion<ScalarLane>.HasFollowed(batch) || !_closure.TryCloseEnd(tolerance))
        {
            return false;
        }

        CompliantAngles<ScalarLane>.AddClosing(batch);
        RattleStep<ScalarLane>.Build(batch);
        VelocityProjection<ScalarLane>.Rest(batch, tolerance, _conjugateGradient);
        return true;
    }

    private void FindVelocities(double h)
    {
        LaneBatch<ScalarLane> batch = _batch;
        double[] solution = batch.Work.Solution;
        for (int pass = 0; ; pass++)
        {
            RattleStep<ScalarLane>.Factor(batch, true);
            Impulses<ScalarLane>.NegativeSpeeds(batch);
            batch.ActiveSet?.AddStepTargets(h);
            if (batch.Shape.IsInconsistent)
            {
                CompliantAngles<ScalarLane>.AddStepTargets(batch);
                DelassusMatrix<ScalarLane>.Solve(batch, solution);
            }
            else
            {
                _conjugateGradient.Solve(true);
            }

            for (int i = 0; i < solution.Length; i++)
            {
                batch.Work.PositionImpulses[i] += solution[i];
            }

            Impulses<ScalarLane>.Apply(batch, solution);
            if (batch.ActiveSet == null || !batch.ActiveSet.UpdateStep(h, pass))
            {
                return;
            }

            batch.ActiveSet.ApplyPending();
        }
    }
}
