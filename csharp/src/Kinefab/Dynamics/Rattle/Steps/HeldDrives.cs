using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Finds the drives without limit of force whose way the joints alone leave no freedom. Such a row j is a combination of theirs, so that what is left of
/// its response when they answer, j M⁻¹ jᵀ − c A⁻¹ cᵀ with c = j M⁻¹ Jᵀ and A = J M⁻¹ Jᵀ (the Schur complement), is nothing: whatever the drive gave would
/// load the joints without end and move nothing. It gives nothing, and stalls.
/// </summary>
internal static class HeldDrives
{
    // Of a row's own response: so far from its dead point no lever is built.
    private const double LeastFree = 1e-9;

    /// <summary>Marks them. Leaves momenta and matrix for the caller to restore.</summary>
    /// <param name="batch">Built at the start pose.</param>
    /// <param name="scalars">Its rows.</param>
    /// <param name="exact">Solves without the matrix's compliance.</param>
    public static void Find(LaneBatch<ScalarLane> batch, ActiveSet<ScalarLane> scalars, ConjugateGradient exact)
    {
        batch.Work.Active[0] = 1;
        scalars.Deactivate();
        RattleStep<ScalarLane>.Factor(batch, false);
        for (int i = 0; i < scalars.Count; i++)
        {
            ref readonly ScalarRow row = ref scalars.Row(i);
            scalars.Hold(i, row.IsEndlessDrive && IsHeld(batch, exact, row));
        }
    }

    private static bool IsHeld(LaneBatch<ScalarLane> batch, ConjugateGradient exact, in ScalarRow row)
    {
        double[] speeds = batch.Work.Solution;
        double[] answer = batch.Work.LastSolution;
        Impulses<ScalarLane>.NegativeSpeeds(batch);
        Array.Copy(speeds, answer, speeds.Length);
        Impulses<ScalarLane>.ApplyRow(batch, row.Block, row.Built, 1);
        Impulses<ScalarLane>.NegativeSpeeds(batch);
        for (int i = 0; i < speeds.Length; i++)
        {
            speeds[i] -= answer[i];
        }

        exact.Solve(false);
        double before = Impulses<ScalarLane>.Speed(batch, row.Block, row.Built);
        Impulses<ScalarLane>.Apply(batch, speeds);
        double response = Impulses<ScalarLane>.ResponseOf(batch, row.Block, row.Built);
        double left = response + Impulses<ScalarLane>.Speed(batch, row.Block, row.Built) - before;
        return left < LeastFree * response;
    }
}
