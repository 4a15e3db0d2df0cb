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

    // Of lanes, each of which leaves of the rest a share like that of the compliance.
    private const int LanePasses = 4;

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
        conjugateGradient.RespondInDrift(stress);
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

            conjugateGradient.RespondInDrift(stress);
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

    /// <summary>
    /// The same of lanes, as far as the factor tells: (A + E)^-1 E, E the compliance, leaves what the rows have against each other as it is, and of the rest next
    /// to nothing.
    /// </summary>
    /// <param name="batch">Built and factored at the start pose; its active lanes have arrived.</param>
    /// <param name="h">Length of the drift, s.</param>
    /// <param name="tolerance">Largest C, metres or radians.</param>
    /// <param name="isLeft">Set for each lane: whether it has such loads still, which alone would be sought by <see cref="ConjugateGradient"/>.</param>
    public static void TakeOut<V>(LaneBatch<V> batch, double h, double tolerance, bool[] isLeft)
        where V : struct, ILane<V>
    {
        Array.Clear(isLeft, 0, isLeft.Length);
        if (!Find(batch))
        {
            return;
        }

        int w = Lane<V>.Width;
        double[] stress = batch.Work.Move, solution = batch.Work.Solution;
        Array.Copy(batch.Work.PositionImpulses, stress, stress.Length);
        Lane<V> most = Lane<V>.Splat(0);
        for (int pass = 0; pass < LanePasses; pass++)
        {
            for (int i = 0; i < stress.Length; i += w)
            {
                (Lane<V>.Load(batch.Compliance, i) * Lane<V>.Load(stress, i)).Store(solution, i);
            }

            DelassusMatrix<V>.Solve(batch, solution);
            most = Lane<V>.Splat(0);
            for (int i = 0; i < stress.Length; i += w)
            {
                Lane<V> next = Lane<V>.Load(solution, i);
                most = Lane<V>.Max(most, Lane<V>.Abs(Lane<V>.Load(batch.Compliance, i) * (Lane<V>.Load(stress, i) - next)));
                next.Store(stress, i);
            }
        }

        // What is left of the rest would move the rows so fast.
        most.Store(batch.Work.Leftover, 0);
        for (int lane = 0; lane < w; lane++)
        {
            isLeft[lane] = batch.Work.Active[lane] != 0 && !(batch.Work.Leftover[lane] <= tolerance / h);
            batch.Work.Active[lane] = isLeft[lane] ? 0 : batch.Work.Active[lane];
        }

        Lane<V> active = Lane<V>.Load(batch.Work.Active, 0);
        for (int i = 0; i < stress.Length; i += w)
        {
            Lane<V> taken = Lane<V>.Select(active, Lane<V>.Load(stress, i), Lane<V>.Splat(0));
            (Lane<V>.Load(batch.Work.PositionImpulses, i) - taken).Store(batch.Work.PositionImpulses, i);
            (Lane<V>.Splat(0) - taken).Store(stress, i);
        }

        Impulses<V>.Apply(batch, stress);
    }

    // Of the active lanes, those whose rows work against each other so stay active.
    private static bool Find<V>(LaneBatch<V> batch)
        where V : struct, ILane<V>
    {
        int w = Lane<V>.Width, numbers = 6 * w;
        double[] impulses = batch.Work.PositionImpulses, momenta = batch.Work.Momenta;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = LaneRecords<V>.Body(body, BodyLanes.V);
            Array.Copy(batch.Bodies, o, momenta, body * numbers, numbers);
            Array.Clear(batch.Bodies, o, numbers);
        }

        Impulses<V>.Apply(batch, impulses);
        Lane<V> surplus = Lane<V>.Splat(-2 * MostCompliant) * LaneEnergy<V>.Kinetic(batch);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            Array.Copy(momenta, body * numbers, batch.Bodies, LaneRecords<V>.Body(body, BodyLanes.V), numbers);
        }

        for (int i = 0; i < impulses.Length; i += w)
        {
            Lane<V> impulse = Lane<V>.Load(impulses, i);
            surplus += Lane<V>.Load(batch.Compliance, i) * impulse * impulse;
        }

        surplus.Store(batch.Work.Leftover, 0);
        bool isAny = false;
        for (int lane = 0; lane < w; lane++)
        {
            batch.Work.Active[lane] = batch.Work.Leftover[lane] > 0 ? batch.Work.Active[lane] : 0;
            isAny |= batch.Work.Active[lane] != 0;
        }

        return isAny;
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
