using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// One RATTLE step with a chord Newton iteration. Momenta take half a kick; impulses along the rows of the start pose
/// then make the pose at the drift's end satisfy C = 0; momenta take the other half, and impulses along the rows of the
/// end pose make them tangent. One factorisation, at the end pose, serves this projection and the next step's iteration.
/// Second order and time-reversible to the tolerance.
/// Source: Andersen 1983; Hairer, Lubich, Wanner, Geometric Numerical Integration, VII.1.4.
/// </summary>
internal static class RattleStep<V>
    where V : struct, ILane<V>
{
    /// <summary>Iterations after which a step counts as failed.</summary>
    public const int MaxIterations = 12;

    // And with conjugate gradients.
    private const int MaxGradientIterations = 40;

    /// <summary>Kick, impulses and drift, until the lanes that are active at the call have a closed end pose.</summary>
    /// <param name="batch">Built and factored at the start pose.</param>
    /// <param name="h">Step, s.</param>
    /// <param name="tolerance">Largest C, metres or radians.</param>
    /// <param name="converged">Set for each lane.</param>
    /// <param name="isEager">Scalar rows keep to their bounds in every iteration instead of at its end alone: dearer, but
    /// rows that contradict each other give way before the drift is led astray. So they do once a drive runs away, see
    /// <see cref="ActiveSet{V}.RunsAway"/>.</param>
    /// <param name="conjugateGradient">Solves for each correction without the matrix's compliance, as long as it takes; null: by the factor alone.</param>
    public static void KickAndDrift(LaneBatch<V> batch, double h, double tolerance, bool[] converged, bool isEager = false, ConjugateGradient? conjugateGradient = null)
    {
        int w = Lane<V>.Width;
        for (int lane = 0; lane < w; lane++)
        {
            converged[lane] = batch.Work.Active[lane] == 0;
        }

        CompliantAngles<V>.Begin(batch, h);
        batch.ActiveSet?.Begin(h, tolerance, false);
        batch.Axes?.WriteRows();
        Kick(batch, h / 2);
        Array.Copy(batch.VelocityImpulses, batch.Work.PositionImpulses, batch.VelocityImpulses.Length);
        Impulses<V>.Apply(batch, batch.Work.PositionImpulses);
        if (batch.ActiveSet != null)
        {
            FactorForDrift(batch, batch.ActiveSet);
        }
        else if (batch.Axes != null)
        {
            FactorForDrift(batch, batch.Axes);
        }
        else if (batch.Shape.IsInconsistent)
        {
            Factor(batch, true);
        }

        FreeMotion<V>.DriftKinematic(batch, h);
        int searches = 0;
        int restart = 0;
        for (int iteration = 0; ; iteration++)
        {
            LockedInertiaAxes<V>.ClearMomentum(batch);
            FreeMotion<V>.Drift(batch, h);
            BilateralRows<V>.Evaluate(batch);
            CompliantAngles<V>.Evaluate(batch);
            batch.ActiveSet?.Evaluate(h);
            batch.Axes?.Evaluate(h);
            BilateralRows<V>.MeasureErrors(batch);
            bool isDone = true;
            for (int lane = 0; lane < w; lane++)
            {
                if (batch.Work.Active[lane] != 0 && ChordIteration<V>.IsClosed(batch, lane, tolerance, iteration > restart && conjugateGradient == null))
                {
                    batch.Work.Active[lane] = 0;
                    converged[lane] = true;
                }

                isDone &= batch.Work.Active[lane] == 0;
            }

            if (isDone && batch.ActiveSet != null && batch.ActiveSet.UpdatePositions(searches++, tolerance))
            {
                batch.Work.Active[0] = 1;
                converged[0] = false;
                restart = iteration;
                Factor(batch, true);
                batch.ActiveSet.Evaluate(h);
                ReleaseAtBound(batch, h, batch.ActiveSet);
                BilateralRows<V>.MeasureErrors(batch);
                batch.Work.FirstMaxError[0] = batch.Work.MaxError[0];
            }
            else if (isDone)
            {
                return;
            }
            else if (iteration - restart == (conjugateGradient == null ? MaxIterations : MaxGradientIterations) || ChordIteration<V>.IsHopeless(batch, iteration == restart))
            {
                return;
            }

            ChordIteration<V>.FindMove(batch, h, iteration == restart, conjugateGradient);
            isEager |= batch.ActiveSet != null && batch.ActiveSet.RunsAway(batch.Work.Move);
            if (isEager && batch.ActiveSet != null)
            {
                restart = MoveWithinBounds(batch, h, batch.ActiveSet, conjugateGradient) ? iteration : restart;
            }
            else
            {
                ChordIteration<V>.Move(batch, batch.Work.PositionImpulses);
            }
        }
    }

    // Rows whose impulses the move leads beyond their bounds give way, and the rest moves on without them; whether one did.
    private static bool MoveWithinBounds(LaneBatch<V> batch, double h, ActiveSet<V> scalars, ConjugateGradient? conjugateGradient)
    {
        for (int pass = 0; ; pass++)
        {
            double share = scalars.ShareOfMove(batch.Work.Move, out int first);
            for (int i = 0; i < batch.Work.Move.Length; i++)
            {
                batch.Work.Move[i] *= share;
                batch.Work.Error[i] *= 1 - share;
            }

            ChordIteration<V>.Move(batch, batch.Work.PositionImpulses);
            if (first < 0)
            {
                return pass > 0;
            }

            scalars.HoldAtBound(first);
            Factor(batch, true);
            ReleaseAtBound(batch, h, scalars);
            ChordIteration<V>.FindMove(batch, h, true, conjugateGradient);
        }
    }

    /// <summary>As <see cref="Build"/>, at an end pose that no drift led to.</summary>
    public static void Rebuild(LaneBatch<V> batch)
    {
        BilateralRows<V>.Evaluate(batch);
        Build(batch);
    }

    /// <summary>Builds and factors the rows at the end pose of the last drift, for all lanes.</summary>
    public static void Build(LaneBatch<V> batch)
    {
        DelassusMatrix<V>.InverseInertias(batch);
        BilateralRows<V>.Build(batch);
        if (batch.Scalars == null)
        {
            Factor(batch, batch.Axes == null);
        }
        else
        {
            batch.Scalars.Invalidate();
        }
    }

    /// <summary>Reads the scalar rows again at the pose where all rows were built, since targets and gains may have changed.</summary>
    public static void ReloadState(LaneBatch<V> batch)
    {
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            if (batch.Shape.Blocks[n].ScalarCount > 0)
            {
                AssembledRows<V>.Read(batch, n);
            }
        }
    }

    /// <summary>The end pose becomes the start pose, in all lanes.</summary>
    public static void Accept(LaneBatch<V> batch)
    {
        double[] a = batch.Bodies;
        for (int body = 0; body < batch.Shape.Bodies.Length; body++)
        {
            int o = LaneBatch<V>.Body(body, 0);
            LaneVector<V>.Load(a, o, BodyLanes.EndX).Store(a, o, BodyLanes.X);
            LaneQuaternion<V>.Load(a, o, BodyLanes.EndQ).Store(a, o, BodyLanes.Q);
        }
    }

    /// <summary>Adds the impulses of the drift and of the projection to those of the whole step, in the active lanes.</summary>
    public static void Accumulate(LaneBatch<V> batch)
    {
        int w = Lane<V>.Width;
        Lane<V> active = Lane<V>.Load(batch.Work.Active, 0);
        for (int i = 0; i < batch.Work.TotalImpulses.Length; i += w)
        {
            Lane<V> sum = Lane<V>.Load(batch.Work.PositionImpulses, i) + Lane<V>.Load(batch.VelocityImpulses, i);
            Lane<V>.Select(active, sum, Lane<V>.Load(batch.Work.TotalImpulses, i)).Store(batch.Work.TotalImpulses, i);
        }
    }

    /// <summary>v += t a, L += t torque in the active lanes.</summary>
    public static void Kick(LaneBatch<V> batch, double t)
    {
        double[] a = batch.Bodies;
        Lane<V> time = Lane<V>.Select(Lane<V>.Load(batch.Work.Active, 0), Lane<V>.Splat(t), Lane<V>.Splat(0));
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<V>.Body(body, 0);
            (LaneVector<V>.Load(a, o, BodyLanes.V) + time * LaneVector<V>.Load(a, o, BodyLanes.Acceleration))
                .Store(a, o, BodyLanes.V);
            (LaneVector<V>.Load(a, o, BodyLanes.L) + time * LaneVector<V>.Load(a, o, BodyLanes.Torque))
                .Store(a, o, BodyLanes.L);
        }
    }

    /// <summary>Assembles and factors the matrix of the built rows.</summary>
    /// <param name="batch">The rows and bodies.</param>
    /// <param name="isDrift">See <see cref="ActiveSet{V}.AddToDiagonal"/>.</param>
    public static void Factor(LaneBatch<V> batch, bool isDrift)
    {
        batch.ActiveSet?.WriteRows(false);
        batch.Axes?.WriteRows();
        double share = !batch.Shape.IsInconsistent ? batch.AngularShare
            : !isDrift ? DelassusMatrix<V>.UnconstrainedShare
            : batch.CompliantStep > 0 ? CompliantAngles<V>.Share(batch.CompliantStep)
            : batch.AngularShare;
        DelassusMatrix<V>.Assemble(batch, share);
        batch.ActiveSet?.AddToDiagonal(isDrift);
        if (batch.Axes != null && batch.Axes.HasSprings())
        {
            DelassusMatrix<V>.Keep(batch);
        }

        batch.Axes?.AddToDiagonal(isDrift);

        DelassusMatrix<V>.Factor(batch);
    }

    // The same of lanes; where springs act the matrix is the projection's but for what they have on the diagonal.
    private static void FactorForDrift(LaneBatch<V> batch, AxisRows<V> axes)
    {
        if (axes.IsFactoredForDrift())
        {
            return;
        }

        if (!axes.IsKeptForDrift())
        {
            Factor(batch, true);
            return;
        }

        Array.Copy(batch.Assembled, batch.Matrix, batch.Matrix.Length);
        axes.AddToDiagonal(true);
        DelassusMatrix<V>.Factor(batch);
    }

    // The projection of the last step leaves the drift's matrix behind, unless a scalar row moved or a spring acts.
    private static void FactorForDrift(LaneBatch<V> batch, ActiveSet<V> scalars)
    {
        if (!batch.Shape.IsInconsistent && scalars.IsFactoredForDrift())
        {
            scalars.WriteRows(false);
        }
        else
        {
            Factor(batch, true);
        }
    }

    // Rows that came to their bounds let go of momentum. What that will open is told to first order and closed by the same
    // correction: alone, it can throw a thin body beyond where the chord finds back from.
    private static void ReleaseAtBound(LaneBatch<V> batch, double h, ActiveSet<V> scalars)
    {
        double[] speeds = batch.Work.Solution;
        double[] before = batch.Work.LastSolution;
        Impulses<V>.NegativeSpeeds(batch);
        Array.Copy(speeds, before, speeds.Length);
        scalars.ApplyPending();
        Impulses<V>.NegativeSpeeds(batch);
        for (int i = 0; i < speeds.Length; i++)
        {
            batch.Work.Error[i] += h * (before[i] - speeds[i]);
        }

        scalars.ClearAtBound(batch.Work.Error);
    }
}
