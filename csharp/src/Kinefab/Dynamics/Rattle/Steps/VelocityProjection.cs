using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The second half of a RATTLE step: half a kick, then impulses l along the rows of the end pose that make the momenta
/// tangent, A l = -J v. The matrix's compliance E leaves the rows speeds of E l; where these are more than small, as they are
/// about slender bodies and beside heavy ones, they are solved for again.
/// </summary>
internal static class VelocityProjection<V>
    where V : struct, ILane<V>
{
    // Speed that the compliance may leave a row, by the step: a small share of what gravity gives, m/s^2 and rad/s^2.
    private const double MostLeft = 3e-3;

    private const int MaxRefinements = 12;

    /// <summary>For the active lanes; needs the rows at the end pose, and their factor where no row has a scalar row.</summary>
    /// <param name="batch">At the end of its drift.</param>
    /// <param name="h">Step, s; 0 without a kick.</param>
    /// <param name="tolerance">Largest C, metres or radians.</param>
    /// <param name="conjugateGradient">On the only lane: solves for what the compliance leaves; null: by iteration.</param>
    public static void Run(LaneBatch<V> batch, double h, double tolerance, ConjugateGradient? conjugateGradient = null)
    {
        RattleStep<V>.Kick(batch, h / 2);
        if (batch.ActiveSet != null)
        {
            batch.ActiveSet.BeginVelocities(tolerance * ActiveSet<V>.Reach);
            RunWithActiveSet(batch, h, tolerance, batch.ActiveSet, conjugateGradient);
            return;
        }

        if (batch.Shape.IsInconsistent)
        {
            RattleStep<V>.Factor(batch, false);
        }

        batch.Axes?.BeginVelocities();
        Impulses<V>.NegativeSpeeds(batch);
        batch.Axes?.AddTargets();
        DelassusMatrix<V>.Solve(batch, batch.Work.Solution);
        Copy(batch, batch.Work.Solution, batch.VelocityImpulses);
        Impulses<V>.Apply(batch, batch.VelocityImpulses);
        Refine(batch, h, conjugateGradient);
    }

    /// <summary>
    /// The blow of the limits that the drift came to, after <see cref="Run"/>; leaves its impulses in place of the projection's. False when it
    /// came to none.
    /// </summary>
    /// <param name="batch">At the end of its drift.</param>
    /// <param name="piece">Length of the drift, s.</param>
    /// <param name="leastFlight">See <see cref="ActiveSet{V}.BeginImpact"/>, s.</param>
    /// <param name="tolerance">Largest C, metres or radians.</param>
    /// <param name="conjugateGradient">On the only lane: solves for what the compliance leaves; null: by iteration.</param>
    public static bool Strike(LaneBatch<V> batch, double piece, double leastFlight, double tolerance, ConjugateGradient? conjugateGradient)
    {
        if (batch.ActiveSet == null || !batch.ActiveSet.BeginImpact(tolerance * ActiveSet<V>.Reach, piece, leastFlight))
        {
            return false;
        }

        RunWithActiveSet(batch, 0, tolerance, batch.ActiveSet, conjugateGradient);
        return true;
    }

    /// <summary>Makes the momenta tangent where the rows are built, with nothing thrown back; leaves its impulses.</summary>
    public static void Rest(LaneBatch<V> batch, double tolerance, ConjugateGradient? conjugateGradient)
    {
        if (batch.ActiveSet == null)
        {
            Run(batch, 0, tolerance, conjugateGradient);
            return;
        }

        batch.ActiveSet.BeginRest(tolerance * ActiveSet<V>.Reach);
        RunWithActiveSet(batch, 0, tolerance, batch.ActiveSet, conjugateGradient);
    }

    private static void RunWithActiveSet(LaneBatch<V> batch, double h, double tolerance, ActiveSet<V> scalars, ConjugateGradient? conjugateGradient)
    {
        int length = batch.Shape.RowCount;
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            Array.Clear(batch.VelocityImpulses, batch.Shape.Pattern.Rows[n], batch.Shape.Blocks[n].BilateralCount);
        }

        for (int pass = 0; ; pass++)
        {
            RattleStep<V>.Factor(batch, false);
            Impulses<V>.NegativeSpeeds(batch);
            scalars.AddTargets();
            DelassusMatrix<V>.Solve(batch, batch.Work.Solution);
            for (int i = 0; i < length; i++)
            {
                batch.VelocityImpulses[i] += batch.Work.Solution[i];
            }

            Impulses<V>.Apply(batch, batch.Work.Solution);
            if (!scalars.UpdateVelocities(pass, tolerance * ActiveSet<V>.Reach))
            {
                Refine(batch, h, conjugateGradient);
                return;
            }
        }
    }

    // A loop that is not exact has no speeds but those that its rows' compliance leaves.
    private static void Refine(LaneBatch<V> batch, double h, ConjugateGradient? conjugateGradient)
    {
        if (!batch.Shape.IsRedundant || batch.Shape.Loops != LoopConsistency.Exact || !IsAnyLeft(batch, h * MostLeft))
        {
            return;
        }

        if (conjugateGradient != null)
        {
            RefineAlone(batch, conjugateGradient);
            return;
        }

        Lane<V> active = Lane<V>.Load(batch.Work.Active, 0);
        Lane<V>.Load(batch.Work.Leftover, 0).Store(batch.Work.Active, 0);
        for (int i = 0; i < MaxRefinements; i++)
        {
            Impulses<V>.NegativeSpeeds(batch);
            batch.ActiveSet?.AddTargets();
            batch.Axes?.AddTargets();
            double[] error = batch.Work.Error;
            for (int k = 0; k < error.Length; k += Lane<V>.Width)
            {
                (Lane<V>.Splat(0) - Lane<V>.Load(batch.Work.Solution, k)).Store(error, k);
            }

            if (!IsAnyKept(batch, h * MostLeft))
            {
                break;
            }

            ChordIteration<V>.FindMove(batch, 1, i == 0);
            ChordIteration<V>.Move(batch, batch.VelocityImpulses);
        }

        active.Store(batch.Work.Active, 0);
    }

    private static void RefineAlone(LaneBatch<V> batch, ConjugateGradient conjugateGradient)
    {
        double[] solution = batch.Work.Solution;
        for (int pass = 0; pass < 2; pass++)
        {
            Impulses<V>.NegativeSpeeds(batch);
            batch.ActiveSet?.AddTargets();
            conjugateGradient.Solve(false);
            for (int i = 0; i < solution.Length; i++)
            {
                batch.VelocityImpulses[i] += solution[i];
            }

            Impulses<V>.Apply(batch, solution);
        }
    }

    // Of the first solution; marks the lanes.
    private static bool IsAnyLeft(LaneBatch<V> batch, double limit)
    {
        int w = Lane<V>.Width;
        Lane<V> most = Lane<V>.Splat(0);
        for (int i = 0; i < batch.VelocityImpulses.Length; i += w)
        {
            most = Lane<V>.Max(most, Lane<V>.Abs(Lane<V>.Load(batch.Compliance, i) * Lane<V>.Load(batch.VelocityImpulses, i)));
        }

        most.Store(batch.Work.Leftover, 0);
        for (int lane = 0; lane < w; lane++)
        {
            batch.Work.Leftover[lane] = batch.Work.Leftover[lane] > limit ? batch.Work.Active[lane] : 0;
        }

        return IsAny(batch.Work.Leftover);
    }

    // Lanes whose rows have no speed left are done.
    private static bool IsAnyKept(LaneBatch<V> batch, double limit)
    {
        int w = Lane<V>.Width;
        Lane<V> most = Lane<V>.Splat(0);
        for (int i = 0; i < batch.Work.Error.Length; i += w)
        {
            most = Lane<V>.Max(most, Lane<V>.Abs(Lane<V>.Load(batch.Work.Error, i)));
        }

        most.Store(batch.Work.Leftover, 0);
        for (int lane = 0; lane < w; lane++)
        {
            batch.Work.Active[lane] = batch.Work.Leftover[lane] > limit ? batch.Work.Active[lane] : 0;
        }

        return IsAny(batch.Work.Active);
    }

    private static bool IsAny(double[] lanes)
    {
        foreach (double lane in lanes)
        {
            if (lane != 0)
            {
                return true;
            }
        }

        return false;
    }

    private static void Copy(LaneBatch<V> batch, double[] from, double[] to)
    {
        int w = Lane<V>.Width;
        Lane<V> active = Lane<V>.Load(batch.Work.Active, 0);
        int length = batch.Shape.RowCount * w;
        for (int i = 0; i < length; i += w)
        {
            Lane<V>.Select(active, Lane<V>.Load(from, i), Lane<V>.Load(to, i)).Store(to, i);
        }
    }
}
