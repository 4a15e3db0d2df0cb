using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The joints' first word on speeds that they do not allow (of a scene as it starts, or set from outside): a blow at the
/// start pose, that takes energy and gives none. Left to the drift it would have to be found with the end pose, where
/// a thin body turns far for a small gap. Without contradiction it does nothing.
/// </summary>
internal static class InitialVelocityProjection
{
    /// <summary>Speed of a locked row that counts as forbidden, m/s or rad/s.</summary>
    public const double MostForbidden = 1e-6;

    /// <summary>The locked row with the largest speed, or -1 where none is forbidden: of the speeds before damping, which takes not as much of all.</summary>
    /// <param name="batch">Built at the start pose.</param>
    /// <param name="speed">Its speed, m/s or rad/s.</param>
    public static int Find(LaneBatch<ScalarLane> batch, out double speed)
    {
        int worst = -1;
        speed = MostForbidden;
        if (batch.Scalars != null)
        {
            // The rows' responses come with the matrix.
            RattleStep<ScalarLane>.Factor(batch, false);
            batch.Scalars.Invalidate();
        }

        Undamp(batch);
        Impulses<ScalarLane>.NegativeSpeeds(batch);
        Dampen(batch);
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            int first = batch.Shape.Pattern.Rows[n];
            for (int i = first; i < first + batch.Shape.Blocks[n].BilateralCount; i++)
            {
                if (Math.Abs(batch.Work.Solution[i]) > speed)
                {
                    worst = i;
                    speed = Math.Abs(batch.Work.Solution[i]);
                }
            }
        }

        return worst;
    }

    /// <summary>Projects the momenta on what the rigid rows allow.</summary>
    /// <param name="batch">Built at the start pose; factored for the drift again where there are no scalar rows.</param>
    /// <param name="conjugateGradient">Solves without the matrix's compliance.</param>
    public static void Apply(LaneBatch<ScalarLane> batch, ConjugateGradient conjugateGradient)
    {
        double[] blow = batch.Work.Solution;
        batch.Work.Active[0] = 1;
        batch.ActiveSet?.Deactivate();
        RattleStep<ScalarLane>.Factor(batch, false);
        Impulses<ScalarLane>.NegativeSpeeds(batch);
        if (batch.Shape.Loops == LoopConsistency.Exact)
        {
            conjugateGradient.Solve(false);
        }
        else
        {
            batch.ActiveSet?.ClearAtBound(blow);
            DelassusMatrix<ScalarLane>.Solve(batch, blow);
        }

        Impulses<ScalarLane>.Apply(batch, blow);
        for (int i = 0; i < blow.Length; i++)
        {
            batch.Work.TotalImpulses[i] += blow[i];
        }

        if (batch.ActiveSet == null)
        {
            RattleStep<ScalarLane>.Factor(batch, true);
        }
    }

    // Of a speed of which damping leaves nothing, nothing is known.
    private static void Undamp(LaneBatch<ScalarLane> batch)
    {
        double[] a = batch.Bodies;
        Vector3d frame = LaneTransfer<ScalarLane>.ReadVector(batch.Work.FrameVelocity, 0);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, 0);
            Array.Copy(a, o + BodyLanes.V, batch.Work.Momenta, 6 * body, 6);
            double linear = a[o + BodyLanes.DampingFactors];
            double angular = a[o + BodyLanes.DampingFactors + 1];
            if (linear > 0)
            {
                Vector3d damped = LaneTransfer<ScalarLane>.ReadVector(a, o + BodyLanes.V) + frame;
                LaneTransfer<ScalarLane>.Write(a, o + BodyLanes.V, damped * (1 / linear) - frame);
            }

            if (angular > 0)
            {
                LaneTransfer<ScalarLane>.Write(a, o + BodyLanes.L, LaneTransfer<ScalarLane>.ReadVector(a, o + BodyLanes.L) * (1 / angular));
            }
        }
    }

    private static void Dampen(LaneBatch<ScalarLane> batch)
    {
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            Array.Copy(batch.Work.Momenta, 6 * body, batch.Bodies, LaneBatch<ScalarLane>.Body(body, BodyLanes.V), 6);
        }
    }
}
