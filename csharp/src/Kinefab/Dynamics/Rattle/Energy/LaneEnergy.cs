using System;
using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Energy of the islands of a batch, each in its lane.</summary>
internal static class LaneEnergy<V>
    where V : struct, ILane<V>
{
    // Steps, and seconds, for which forces act to give what counts as moving in what only begins to.
    private const double Early = 2;
    private const double LeastTime = 1e-3;

    /// <summary>Kinetic energy by the bodies' velocities and momenta, J.</summary>
    public static Lane<V> Kinetic(LaneRecords<V> batch)
    {
        Lane<V> sum = Lane<V>.Splat(0);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            sum += Twice(batch.Bodies, LaneRecords<V>.Body(body, 0));
        }

        return Lane<V>.Splat(0.5) * sum;
    }

    /// <summary>At the end of a step, from its start in X: what the bodies' constant forces gave in it, J.</summary>
    public static Lane<V> Work(LaneRecords<V> batch)
    {
        Lane<V> sum = Lane<V>.Splat(0);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            sum += Work(batch.Bodies, LaneRecords<V>.Body(body, 0));
        }

        return sum;
    }

    /// <summary>What they give to bodies at rest in the first steps, J.</summary>
    public static Lane<V> Forced(LaneRecords<V> batch, double dt)
    {
        Lane<V> sum = Lane<V>.Splat(0);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            sum += Forced(batch.Bodies, LaneRecords<V>.Body(body, 0));
        }

        double time = Math.Max(Early * dt, LeastTime);
        return Lane<V>.Splat(time * time / 2) * sum;
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static Lane<V> Twice(double[] a, int o)
    {
        LaneVector<V> v = LaneVector<V>.Load(a, o, BodyLanes.V);
        return LaneVector<V>.Dot(v, v) / Lane<V>.Load(a, o, BodyLanes.InverseMass)
            + LaneVector<V>.Dot(LaneVector<V>.Load(a, o, BodyLanes.L), LaneVector<V>.Load(a, o, BodyLanes.W));
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static Lane<V> Work(double[] a, int o)
    {
        LaneVector<V> way = LaneVector<V>.Load(a, o, BodyLanes.EndX) - LaneVector<V>.Load(a, o, BodyLanes.X);
        return LaneVector<V>.Dot(LaneVector<V>.Load(a, o, BodyLanes.Acceleration), way) / Lane<V>.Load(a, o, BodyLanes.InverseMass);
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static Lane<V> Forced(double[] a, int o)
    {
        LaneVector<V> acceleration = LaneVector<V>.Load(a, o, BodyLanes.Acceleration);
        return LaneVector<V>.Dot(acceleration, acceleration) / Lane<V>.Load(a, o, BodyLanes.InverseMass);
    }
}
