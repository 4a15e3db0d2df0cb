using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>
/// One RATTLE step with a chord Newton iteration. Momenta take half a kick; impulses along the rows of the start pose
/// then make the pose at the flight's end satisfy C = 0; momenta take the other half, and impulses along the rows of the
/// end pose make them tangent. One factorisation, at the end pose, serves this projection and the next step's iteration.
/// Second order and time-reversible to the tolerance.
/// Source: Andersen 1983; Hairer, Lubich, Wanner, Geometric Numerical Integration, VII.1.4.
/// </summary>
internal static class RattleStep<V>
    where V : struct, ILane<V>
{
    /// <summary>Iterations after which a step counts as failed.</summary>
    public const int MaxIterations = 12;

    // A limit this many tolerances away counts as reached.
    private const double LimitReach = 10;

    // A mode that contracts by less than one part in four is not sped up further: it is the part of an inexact loop that
    // cannot close, and chasing it would load the loop without end.
    private const double MostMixing = 4;

    // An error that does not fall below this share of itself in an iteration gets no better.
    private const double StillShare = 0.25;

    // Tolerances that anchors may be apart then: with the speed of a short step little changes in an iteration, closed or not.
    private const double MostGaps = 4;

    // Largest error of an angle that may be left then, radians.
    private const double MostAngle = 1e-3;

    // Growth of the error against the first flight's at which the iteration is given up.
    private const double MostGrowth = 4;

    // Keeps 0 / 0 out of the mixing.
    private const double LeastSquare = 1e-300;

    /// <summary>Kick, impulses and flight, until the lanes that are active at the call have a closed end pose.</summary>
    /// <param name="batch">Built and factored at the start pose.</param>
    /// <param name="h">Step, s.</param>
    /// <param name="tolerance">Largest C, metres or radians.</param>
    /// <param name="converged">Set for each lane.</param>
    /// <param name="isEager">Rows with a law keep to their bounds in every iteration instead of at its end alone: dearer, but
    /// rows that contradict each other give way before the flight is led astray.</param>
    public static void Fly(Batch<V> batch, double h, double tolerance, bool[] converged, bool isEager = false)
    {
        int w = Lane<V>.Width;
        for (int lane = 0; lane < w; lane++)
        {
            converged[lane] = batch.Work.Active[lane] == 0;
        }

        batch.SoftStep = batch.Shape.IsInexact ? h : 0;
        batch.Laws?.Begin(h, false);
        Kick(batch, h / 2);
        Array.Copy(batch.Half, batch.Work.First, batch.Half.Length);
        Impulses<V>.Apply(batch, batch.Work.First);
        if (batch.Laws != null)
        {
            FactorForFlight(batch, batch.Laws);
        }
        else if (batch.Shape.IsInexact)
        {
            Factor(batch, true);
        }

        Flight<V>.MoveKinematic(batch, h);
        int lawPasses = 0;
        int restart = 0;
        for (int iteration = 0; ; iteration++)
        {
            FrozenAxes<V>.Clear(batch);
            Flight<V>.Run(batch, h);
            RigidRows<V>.Evaluate(batch);
            batch.Laws?.Evaluate(h);
            RigidRows<V>.Rate(batch);
            bool isDone = true;
            for (int lane = 0; lane < w; lane++)
            {
                if (batch.Work.Active[lane] != 0 && IsClosed(batch, lane, tolerance, iteration > restart))
                {
                    batch.Work.Active[lane] = 0;
                    converged[lane] = true;
                }

                isDone &= batch.Work.Active[lane] == 0;
            }

            if (isDone && batch.Laws != null && batch.Laws.Update(lawPasses++, tolerance))
            {
                batch.Work.Active[0] = 1;
                converged[0] = false;
                restart = iteration;
                Factor(batch, true);
                batch.Laws.Evaluate(h);
                LetGo(batch, h, batch.Laws);
                RigidRows<V>.Rate(batch);
                batch.Work.FirstMaxError[0] = batch.Work.MaxError[0];
            }
            else if (isDone)
            {
                return;
            }
            else if (iteration - restart == MaxIterations || IsHopeless(batch, iteration == restart))
            {
                return;
            }

            Correct(batch, h, iteration == restart);
            while (isEager && batch.Laws != null && batch.Laws.ClampOutside())
            {
                Array.Clear(batch.Work.Error, 0, batch.Work.Error.Length);
                Factor(batch, true);
                LetGo(batch, h, batch.Laws);
                Correct(batch, h, true);
                restart = iteration;
            }
        }
    }

    /// <summary>As <see cref="Build"/>, at an end pose that no flight led to.</summary>
    public static void Rebuild(Batch<V> batch)
    {
        RigidRows<V>.Place(batch);
        Build(batch);
    }

    /// <summary>Builds and factors the rows at the end pose of the last flight, for all lanes.</summary>
    public static void Build(Batch<V> batch)
    {
        ResponseMatrix<V>.InverseInertias(batch);
        RigidRows<V>.Build(batch);
        if (batch.Laws == null)
        {
            Factor(batch, true);
        }
        else
        {
            batch.Laws.Invalidate();
        }
    }

    /// <summary>Reads the rows with a law again at the pose where all rows were built, since targets and gains may have changed.</summary>
    public static void Reread(Batch<V> batch)
    {
        for (int n = 0; n < batch.Shape.Nodes.Length; n++)
        {
            if (batch.Shape.Nodes[n].Laws > 0)
            {
                PreparedRows<V>.Build(batch, n);
            }
        }
    }

    /// <summary>Second kick and projection of the momenta in the active lanes; needs the rows at the end pose.</summary>
    public static void Project(Batch<V> batch, double h, double tolerance)
    {
        Kick(batch, h / 2);
        if (batch.Laws != null)
        {
            ProjectWithLaws(batch, tolerance, batch.Laws);
            return;
        }

        if (batch.Shape.IsInexact)
        {
            Factor(batch, false);
        }

        Impulses<V>.NegativeSpeeds(batch);
        BlockCholesky<V>.Solve(batch.Shape.Pattern, batch.Matrix, batch.Work.Solution);
        Copy(batch, batch.Work.Solution, batch.Half);
        Impulses<V>.Apply(batch, batch.Half);
    }

    /// <summary>The end pose becomes the start pose, in all lanes.</summary>
    public static void Accept(Batch<V> batch)
    {
        int w = Lane<V>.Width;
        double[] a = batch.Bodies;
        for (int body = 0; body < batch.Shape.Bodies.Length; body++)
        {
            int o = Batch<V>.Body(body, 0);
            LaneVector<V>.Load(a, o + BodySlot.EndX * w).Store(a, o + BodySlot.X * w);
            LaneQuaternion<V>.Load(a, o + BodySlot.EndQ * w).Store(a, o + BodySlot.Q * w);
        }
    }

    /// <summary>Total = First + Half in the active lanes.</summary>
    public static void AddUp(Batch<V> batch)
    {
        int w = Lane<V>.Width;
        Lane<V> active = Lane<V>.Load(batch.Work.Active, 0);
        for (int i = 0; i < batch.Work.Total.Length; i += w)
        {
            Lane<V> sum = Lane<V>.Load(batch.Work.First, i) + Lane<V>.Load(batch.Half, i);
            Lane<V>.Select(active, sum, Lane<V>.Load(batch.Work.Total, i)).Store(batch.Work.Total, i);
        }
    }

    /// <summary>v += t a, L += t torque in the active lanes.</summary>
    public static void Kick(Batch<V> batch, double t)
    {
        int w = Lane<V>.Width;
        double[] a = batch.Bodies;
        Lane<V> time = Lane<V>.Select(Lane<V>.Load(batch.Work.Active, 0), Lane<V>.Splat(t), Lane<V>.Splat(0));
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = Batch<V>.Body(body, 0);
            (LaneVector<V>.Load(a, o + BodySlot.V * w) + time * LaneVector<V>.Load(a, o + BodySlot.Acceleration * w))
                .Store(a, o + BodySlot.V * w);
            (LaneVector<V>.Load(a, o + BodySlot.L * w) + time * LaneVector<V>.Load(a, o + BodySlot.Torque * w))
                .Store(a, o + BodySlot.L * w);
        }
    }

    /// <summary>Assembles and factors the matrix of the built rows.</summary>
    /// <param name="batch">The rows and bodies.</param>
    /// <param name="isFlight">See <see cref="Laws{V}.Condition"/>.</param>
    public static void Factor(Batch<V> batch, bool isFlight)
    {
        batch.Laws?.WriteRows(false);
        ResponseMatrix<V>.Assemble(batch, batch.Shape.IsInexact && !isFlight ? ResponseMatrix<V>.NoPartShare : batch.AngularShare);
        batch.Laws?.Condition(isFlight);
        BlockCholesky<V>.Factor(batch.Shape.Pattern, batch.Matrix);
    }

    // The projection of the last step leaves the flight's matrix behind, unless a law moved or a spring acts.
    private static void FactorForFlight(Batch<V> batch, Laws<V> laws)
    {
        if (!batch.Shape.IsInexact && laws.IsFactoredForFlight())
        {
            laws.WriteRows(false);
        }
        else
        {
            Factor(batch, true);
        }
    }

    // Rows that came to their bounds let go of momentum. What that will open is told to first order and closed by the same
    // correction: alone, it can throw a thin body beyond where the chord finds back from.
    private static void LetGo(Batch<V> batch, double h, Laws<V> laws)
    {
        double[] speeds = batch.Work.Solution;
        double[] before = batch.Work.LastSolution;
        Impulses<V>.NegativeSpeeds(batch);
        Array.Copy(speeds, before, speeds.Length);
        laws.ApplyJumps();
        Impulses<V>.NegativeSpeeds(batch);
        for (int i = 0; i < speeds.Length; i++)
        {
            batch.Work.Error[i] += h * (before[i] - speeds[i]);
        }

        laws.ClearClamped(batch.Work.Error);
    }

    private static void ProjectWithLaws(Batch<V> batch, double tolerance, Laws<V> laws)
    {
        laws.BeginProjection(tolerance * LimitReach);
        int length = batch.Shape.Pattern.RowCount;
        for (int n = 0; n < batch.Shape.Nodes.Length; n++)
        {
            Array.Clear(batch.Half, batch.Shape.Pattern.Rows[n], batch.Shape.Nodes[n].RigidRows);
        }

        for (int pass = 0; ; pass++)
        {
            Factor(batch, false);
            Impulses<V>.NegativeSpeeds(batch);
            laws.AddTargets();
            BlockCholesky<V>.Solve(batch.Shape.Pattern, batch.Matrix, batch.Work.Solution);
            for (int i = 0; i < length; i++)
            {
                batch.Half[i] += batch.Work.Solution[i];
            }

            Impulses<V>.Apply(batch, batch.Work.Solution);
            if (!laws.UpdateProjection(pass, tolerance * LimitReach))
            {
                return;
            }
        }
    }

    /// <summary>
    /// Closed, or as closed as an over-constrained loop that was not made exactly can be: nothing moves any more, or the
    /// anchors meet and the angles, near enough, get no better. Going on would load such a loop without end, and stir up
    /// the turns of slender bodies, on which the chord contracts least. In an island known to be inexact whose angles
    /// are not springs (implicit Euler) the anchors suffice.
    /// </summary>
    public static bool IsClosed(Batch<V> batch, int lane, double tolerance, bool isRepeated)
    {
        double error = batch.Work.MaxError[lane];
        bool isStill = error >= StillShare * batch.Work.LastMaxError[lane];
        batch.Work.LastMaxError[lane] = error;
        return error < tolerance
            || (batch.Shape.IsInexact && batch.SoftStep == 0 && batch.Work.MaxGap[lane] < tolerance)
            || (isRepeated && batch.Work.MaxChange[lane] < tolerance && batch.Work.MaxGap[lane] < MostGaps * tolerance && error < MostAngle)
            || (isRepeated && isStill && batch.Work.MaxGap[lane] < tolerance && error < MostAngle);
    }

    // Lanes whose error grows beyond what they started with are given up; true when none is left.
    private static bool IsHopeless(Batch<V> batch, bool isFirst)
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

    // d = -A^-1 C / h, then Anderson's mixing of depth one: with d and the change of d since the last iteration, the share
    // of the last move that makes |d| least is taken back. It makes of the chord's linear convergence (|w| h an iteration)
    // nearly that of Newton's method, for a few inner products. Source: Walker and Ni 2011.
    private static void Correct(Batch<V> batch, double h, bool isFirst)
    {
        int w = Lane<V>.Width;
        double[] d = batch.Work.Solution;
        double[] last = batch.Work.LastSolution;
        double[] move = batch.Work.Move;
        Lane<V> rate = Lane<V>.Splat(-1 / h);
        int length = batch.Shape.Pattern.RowCount * w;
        for (int i = 0; i < length; i += w)
        {
            (rate * Lane<V>.Load(batch.Work.Error, i)).Store(d, i);
        }

        BlockCholesky<V>.Solve(batch.Shape.Pattern, batch.Matrix, d);
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
        Lane<V> active = Lane<V>.Load(batch.Work.Active, 0);
        for (int i = 0; i < length; i += w)
        {
            Lane<V> now = Lane<V>.Load(d, i);
            Lane<V> step = isFirst ? now : now - share * (Lane<V>.Load(move, i) + (now - Lane<V>.Load(last, i)));
            now.Store(last, i);
            step.Store(move, i);
            Lane<V> first = Lane<V>.Load(batch.Work.First, i);
            Lane<V>.Select(active, first + step, first).Store(batch.Work.First, i);
        }

        Impulses<V>.Apply(batch, move);
    }

    private static void Copy(Batch<V> batch, double[] from, double[] to)
    {
        int w = Lane<V>.Width;
        Lane<V> active = Lane<V>.Load(batch.Work.Active, 0);
        int length = batch.Shape.Pattern.RowCount * w;
        for (int i = 0; i < length; i += w)
        {
            Lane<V>.Select(active, Lane<V>.Load(from, i), Lane<V>.Load(to, i)).Store(to, i);
        }
    }
}
