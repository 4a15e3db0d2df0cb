using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The iteration by which a drift's impulses are found, with the matrix of its start pose throughout: when it has arrived,
/// when it will not, and its next correction.
/// </summary>
internal static class ChordIteration<V>
    where V : struct, ILane<V>
{
    /// <summary>Tolerances by which an angle of an exact loop may stay open.</summary>
    public const double MostLeftOpen = 100;

    /// <summary>
    /// Tolerances that anchors may be apart where nothing moves any more, along each axis: with the speed of a short step little changes in an iteration, closed
    /// or not.
    /// </summary>
    public const double MostGaps = 4;

    // A mode that contracts by less than one part in four is not sped up further: it is the part of an inconsistent loop that
    // cannot close, and chasing it would load the loop without end.
    private const double MostMixing = 4;

    // An error that does not fall below this share of itself in an iteration gets no better.
    private const double StillShare = 0.9;

    // Largest error of an angle that may be left where it gets no better, radians.
    private const double MostAngle = 1e-3;

    // Growth of the error against the first drift's at which the iteration is given up.
    private const double MostGrowth = 4;

    // Keeps 0 / 0 out of the mixing.
    private const double LeastSquare = 1e-300;

    /// <summary>
    /// Closed, or as closed as an over-constrained loop that was not made exactly can be: nothing moves any more, or the
    /// anchors meet and the angles, near enough, get no better. Going on would load such a loop without end, and stir up
    /// the turns of slender bodies, on which the chord contracts least.
    /// </summary>
    public static bool IsClosed(LaneBatch<V> batch, int lane, double tolerance, bool isRepeated)
    {
        double error = batch.Work.MaxError[lane];
        bool isStill = error >= StillShare * batch.Work.LastMaxError[lane];
        batch.Work.LastMaxError[lane] = error;
        return error < tolerance
            || (isRepeated && batch.Work.MaxChange[lane] < tolerance && batch.Work.MaxGap[lane] < MostGaps * tolerance && error < MostAngle)
            || (isRepeated && isStill && batch.Work.MaxGap[lane] < tolerance && error < MostAngle);
    }

    /// <summary>Gives up lanes whose error grows beyond what they started with; true when none is left.</summary>
    public static bool IsHopeless(LaneBatch<V> batch, bool isFirst)
    {
        bool isAny = false;
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            double error = batch.Work.MaxError[lane];
            if (isFirst)
            {
                batch.Work.FirstMaxError[lane] = error;
            }

            if (!(error <= MostGrowth * batch.Work.FirstMaxError[lane]))
            {
                batch.Work.Active[lane] = 0;
            }

            isAny |= batch.Work.Active[lane] != 0;
        }

        return !isAny;
    }

    /// <summary>
    /// The next correction into the move: d = -A^-1 C / h, then Anderson's mixing of depth one: with d and the change of d since the last iteration, the share
    /// of the last move that makes |d| least is taken back. It makes of the chord's linear convergence (|w| h an iteration)
    /// nearly that of Newton's method, for a few inner products. Source: Walker and Ni 2011.
    /// </summary>
    /// <param name="batch">Factored at the start pose, with the errors at the end pose.</param>
    /// <param name="h">Step, s.</param>
    /// <param name="isFirst">Whether no correction of the same matrix went before.</param>
    /// <param name="conjugateGradient">Solves without the matrix's compliance; null: by the factor alone.</param>
    public static void FindMove(LaneBatch<V> batch, double h, bool isFirst, ConjugateGradient? conjugateGradient = null)
    {
        int w = Lane<V>.Width;
        double[] d = batch.Work.Solution;
        double[] last = batch.Work.LastSolution;
        double[] move = batch.Work.Move;
        Lane<V> rate = Lane<V>.Splat(-1 / h);
        int length = batch.Shape.RowCount * w;
        double[] errors = batch.Work.Error;
        for (int i = 0; i < length; i += w)
        {
            (rate * Lane<V>.Load(errors, i)).Store(d, i);
        }

        if (conjugateGradient == null)
        {
            DelassusMatrix<V>.Solve(batch, d);
        }
        else
        {
            conjugateGradient.Solve(true);
        }

        Lane<V> product = Lane<V>.Splat(0);
        Lane<V> square = Lane<V>.Splat(LeastSquare);
        if (!isFirst)
        {
            for (int i = 0; i < length; i += w)
            {
                Lane<V> change = Lane<V>.Load(d, i) - Lane<V>.Load(last, i);
                product += Lane<V>.Load(d, i) * change;
                square += change * change;
            }
        }

        Lane<V> most = Lane<V>.Splat(MostMixing);
        Lane<V> share = Lane<V>.Min(most, Lane<V>.Max(Lane<V>.Splat(-MostMixing), product / square));
        for (int i = 0; i < length; i += w)
        {
            Lane<V> now = Lane<V>.Load(d, i);
            Lane<V> step = isFirst ? now : now - share * (Lane<V>.Load(move, i) + (now - Lane<V>.Load(last, i)));
            now.Store(last, i);
            step.Store(move, i);
        }
    }

    /// <summary>Adds the move to impulses, in the active lanes, and gives the momenta what they have of it.</summary>
    public static void Move(LaneBatch<V> batch, double[] impulses)
    {
        int w = Lane<V>.Width;
        double[] move = batch.Work.Move;
        Lane<V> active = Lane<V>.Load(batch.Work.Active, 0);
        for (int i = 0; i < batch.Shape.RowCount * w; i += w)
        {
            Lane<V> sum = Lane<V>.Load(impulses, i);
            Lane<V>.Select(active, sum + Lane<V>.Load(move, i), sum).Store(impulses, i);
        }

        Impulses<V>.Apply(batch, move);
    }
}
