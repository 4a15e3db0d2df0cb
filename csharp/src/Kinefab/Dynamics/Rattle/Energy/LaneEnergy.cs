using System;
using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Energy of the islands of a batch, each in its lane.</summary>
internal static class LaneEnergy<V>
    where V : struct, ILane<V>
{
    // Steps, and at least seconds, in which forces give what counts as moving where nothing moves yet.
    private const double EarlySteps = 2;
    private const double LeastTime = 1e-3;

    // Of what moves, the part of a common motion that leaves nothing but rounding.
    private const double Rounding = 1e-12;

    /// <summary>Kinetic energy where the rows were last built, J.</summary>
    public static Lane<V> Kinetic(LaneRecords<V> batch)
    {
        Lane<V> sum = Lane<V>.Splat(0);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            sum += TwiceKinetic(batch.Bodies, LaneRecords<V>.Body(body, 0));
        }

        return Lane<V>.Splat(0.5) * sum;
    }

    /// <summary>What the bodies' forces gave from the start pose to the end pose, J.</summary>
    public static Lane<V> Work(LaneRecords<V> batch)
    {
        Lane<V> sum = Lane<V>.Splat(0);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            sum += Work(batch.Bodies, LaneRecords<V>.Body(body, 0));
        }

        return sum;
    }

    /// <summary>What forces give in the first steps from rest, J.</summary>
    public static Lane<V> FirstWork(LaneRecords<V> batch, double dt)
    {
        Lane<V> sum = Lane<V>.Splat(0);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            sum += TwicePower(batch.Bodies, LaneRecords<V>.Body(body, 0));
        }

        double time = Math.Max(EarlySteps * dt, LeastTime);
        return Lane<V>.Splat(time * time / 2) * sum;
    }

    /// <summary>The most that kinematic bodies gave: each row's impulse at the speed that they have along it, which is theirs for the whole step.</summary>
    /// <param name="batch">Built at the end pose.</param>
    /// <param name="impulses">Of all rows, N s or N m s.</param>
    public static Lane<V> KinematicWorkBound(LaneRecords<V> batch, double[] impulses)
    {
        double[] speeds = batch.Work.Solution;
        double[] without = batch.Work.LastSolution;
        Impulses<V>.NegativeSpeeds(batch, false);
        Array.Copy(speeds, without, speeds.Length);
        Impulses<V>.NegativeSpeeds(batch);
        Lane<V> sum = Lane<V>.Splat(0);
        for (int i = 0; i < speeds.Length; i += Lane<V>.Width)
        {
            sum += Lane<V>.Abs((Lane<V>.Load(speeds, i) - Lane<V>.Load(without, i)) * Lane<V>.Load(impulses, i));
        }

        return sum;
    }

    /// <summary>Whether nothing does work on a lane's island but its bodies' own constant forces, its rows' drives and kinematic bodies.</summary>
    public static bool IsKnown(LaneRecords<V> batch, int lane)
    {
        bool isKnown = true;
        for (int body = 0; body < batch.Shape.MovingBodies && isKnown; body++)
        {
            isKnown = LaneTransfer<V>.ReadVector(batch.Bodies, LaneRecords<V>.Body(body, BodyLanes.Torque) + lane) == Vector3d.Zero;
        }

        return isKnown;
    }

    /// <summary>Whether a kinematic body of a lane's island moves in the step: one that stands gives no more than the world does.</summary>
    public static bool IsLed(LaneRecords<V> batch, int lane)
    {
        Island shape = batch.Shape;
        bool isLed = false;
        for (int body = shape.MovingBodies; body < shape.Bodies.Length && shape.HasKinematic && !isLed; body++)
        {
            int o = LaneRecords<V>.Body(body, 0) + lane;
            isLed = !shape.IsStatic[body] && (LaneTransfer<V>.ReadVector(batch.Bodies, o + BodyLanes.V * Lane<V>.Width) != Vector3d.Zero
                || LaneTransfer<V>.ReadVector(batch.Bodies, o + BodyLanes.W * Lane<V>.Width) != Vector3d.Zero);
        }

        return isLed;
    }

    /// <summary>What energy may be taken of, J: all that moves, or of an island that hangs on nothing what it has beyond its <see cref="CommonMotion"/>.</summary>
    /// <param name="batch">Built at the end pose.</param>
    /// <param name="lane">The island's.</param>
    /// <param name="kinetic">What moves, J.</param>
    /// <param name="common">Its common motion, for <see cref="Take"/>.</param>
    public static double Takeable(LaneRecords<V> batch, int lane, double kinetic, out CommonMotion common)
    {
        common = default;
        if (!batch.Shape.IsFloating)
        {
            return kinetic;
        }

        common = CommonMotion.Of(batch, lane, out double energy);
        return kinetic - energy > Rounding * kinetic ? kinetic - energy : 0;
    }

    /// <summary>Takes as much of an energy from the speeds of a lane's bodies as they can give, or gives it to them.</summary>
    /// <param name="batch">The island is one of these.</param>
    /// <param name="lane">Its lane.</param>
    /// <param name="energy">What is to be taken, J.</param>
    /// <param name="takeable">See <see cref="Takeable"/>, J.</param>
    /// <param name="common">See there.</param>
    public static void Take(LaneRecords<V> batch, int lane, double energy, double takeable, in CommonMotion common)
    {
        if (energy == 0 || !(takeable > 0))
        {
            return;
        }

        int w = Lane<V>.Width;
        double factor = Math.Sqrt(1 - Math.Min(EnergyLedger.MostOfKinetic, energy / takeable));
        if (batch.Shape.IsFloating)
        {
            for (int body = 0; body < batch.Shape.MovingBodies; body++)
            {
                common.ScaleRest(batch, body, lane, factor);
            }

            return;
        }

        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            // L follows V.
            int o = LaneRecords<V>.Body(body, BodyLanes.V) + lane;
            for (int i = 0; i < 6; i++)
            {
                batch.Bodies[o + i * w] *= factor;
            }
        }
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static Lane<V> TwiceKinetic(double[] a, int o)
    {
        LaneVector<V> v = LaneVector<V>.Load(a, o, BodyLanes.V);
        LaneVector<V> momentum = LaneVector<V>.Load(a, o, BodyLanes.L);
        return LaneVector<V>.Dot(v, v) / Lane<V>.Load(a, o, BodyLanes.InverseMass)
            + LaneVector<V>.Dot(momentum, LaneVector<V>.Transform(a, o, BodyLanes.WorldInverse, momentum));
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static Lane<V> Work(double[] a, int o)
    {
        LaneVector<V> way = LaneVector<V>.Load(a, o, BodyLanes.EndX) - LaneVector<V>.Load(a, o, BodyLanes.X);
        return LaneVector<V>.Dot(LaneVector<V>.Load(a, o, BodyLanes.Acceleration), way) / Lane<V>.Load(a, o, BodyLanes.InverseMass);
    }

    // m a^2, J/s^2.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static Lane<V> TwicePower(double[] a, int o)
    {
        LaneVector<V> acceleration = LaneVector<V>.Load(a, o, BodyLanes.Acceleration);
        return LaneVector<V>.Dot(acceleration, acceleration) / Lane<V>.Load(a, o, BodyLanes.InverseMass);
    }
}
