using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The joints' first word on speeds that they do not allow (of a scene as it starts, or set from outside): a blow at the
/// start pose, that takes energy and gives none. Left to the drift it would have to be found with the end pose, where
/// a thin body turns far for a small gap. Without contradiction it does nothing.
/// </summary>
internal static class InitialVelocityProjection
{
    /// <summary>Projects the momenta on what the rigid rows allow.</summary>
    /// <param name="batch">Built at the start pose; factored for the drift again where there are no scalar rows.</param>
    /// <param name="exact">Solves without the matrix's compliance.</param>
    public static void Apply(LaneBatch<ScalarLane> batch, ConjugateGradient exact)
    {
        double[] blow = batch.Work.Solution;
        batch.Work.Active[0] = 1;
        batch.ActiveSet?.Deactivate();
        RattleStep<ScalarLane>.Factor(batch, false);
        Impulses<ScalarLane>.NegativeSpeeds(batch);
        exact.Solve(false);
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
}
