using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// What rows that repeat each other are loaded with against each other, of which no body feels anything. A drift whose first pose is far off has it: there
/// the rows of a loop contradict each other, and what the matrix's compliance makes of that grows to thousands of times the load that is carried, none of
/// which a later correction takes back. Joints would break by it, and over the gap that a tolerance leaves between anchors it is a torque.
/// </summary>
internal static class SelfStress
{
    // Of the energy that impulses give the bodies, the most that they leave in the compliance where no row works against another: it is 1e-6 to 1e-4.
    private const double MostCompliant = 1e-3;

    // Of the solve: what the first leaves is small beside a spring's load, not beside what holds it.
    private const int Passes = 2;

    // Of the energy that impulses give the bodies, what may be taken with it: of a tiny body the rounding of a great load is more than a tolerance moves.
    private const double MostMoved = 1e-5;

    // Of the largest impulse, what may be taken from a row with bounds: its state follows from it.
    private const double MostScalar = 1e-6;

    /// <summary>Takes it out of the impulses of a drift that has arrived.</summary>
    /// <param name="batch">Built and factored at the start pose.</param>
    /// <param name="h">Length of the drift, s.</param>
    /// <param name="tolerance">Largest C, metres or radians.</param>
    /// <param name="conjugateGradient">Of the batch.</param>
    public static void TakeOut(LaneBatch<ScalarLane> batch, double h, double tolerance, ConjugateGradient conjugateGradient)
    {
        double[] impulses = batch.Work.PositionImpulses;
        double[] stress = batch.Work.Move;
        Array.Copy(impulses, stress, impulses.Length);
        batch.ActiveSet?.ClearAtBound(stress);
        conjugateGradient.Respond(stress, true);
        double energy = DenseVector.Dot(stress, batch.Work.Solution);
        if (!(CompliantEnergy(batch, stress) > MostCompliant * energy))
        {
            return;
        }

        double most = 0;
        for (int pass = 0; pass < Passes; pass++)
        {
            conjugateGradient.Solve(true);
            most = Math.Max(most, DenseVector.Largest(batch.Work.Solution));
            for (int i = 0; i < stress.Length; i++)
            {
                stress[i] -= batch.Work.Solution[i];
            }

            conjugateGradient.Respond(stress, true);
        }

        bool isMoved = !(DenseVector.Largest(batch.Work.Solution) <= tolerance / h) && !(Math.Abs(DenseVector.Dot(stress, batch.Work.Solution)) <= MostMoved * energy);
        if (isMoved || ChangesScalars(batch, stress, MostScalar * most))
        {
            return;
        }

        for (int i = 0; i < stress.Length; i++)
        {
            impulses[i] -= stress[i];
            stress[i] = -stress[i];
        }

        batch.Work.Active[0] = 1;
        Impulses<ScalarLane>.Apply(batch, stress);
    }

    private static double CompliantEnergy(LaneBatch<ScalarLane> batch, double[] impulses)
    {
        double sum = 0;
        for (int i = 0; i < impulses.Length; i++)
        {
            sum += batch.Compliance[i] * impulses[i] * impulses[i];
        }

        return sum;
    }

    private static bool ChangesScalars(LaneBatch<ScalarLane> batch, double[] impulses, double most)
    {
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            RowBlock block = batch.Shape.Blocks[n];
            for (int i = block.BilateralCount; i < block.Rows; i++)
            {
                if (!(Math.Abs(impulses[batch.Shape.Pattern.Rows[n] + i]) <= most))
                {
                    return true;
                }
            }
        }

        return false;
    }
}
