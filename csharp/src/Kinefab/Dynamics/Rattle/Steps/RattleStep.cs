using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

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
                if (batch.Work.Active[lane] != 0 && ChordIteration<V>.IsClosed(batch, lane, tolerance, iteration > restart))
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
            else if (iteration - restart == MaxIterations || ChordIteration<V>.IsHopeless(batch, iteration == restart))
            {
                return;
            }

            ChordIteration<V>.Correct(batch, h, iteration == restart, batch.Work.First);
            while (isEager && batch.Laws != null && batch.Laws.ClampOutside())
            {
                Array.Clear(batch.Work.Error, 0, batch.Work.Error.Length);
                Factor(batch, true);
                LetGo(batch, h, batch.Laws);
                ChordIteration<V>.Correct(batch, h, true, batch.Work.First);
                restart = iteration;
            }
        }
    }

    /// <summary>As <see cref="Build"/>, at an end pose that no flight led to.</summary>
    public static void Rebuild(Batch<V> batch)
    {
        RigidRows<V>.Evaluate(batch);
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
                PreparedRows<V>.Read(batch, n);
            }
        }
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
}
