using System;
using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Motion of each body under its own momentum over a step h: x' = x + h v, and rotation with the angular momentum L kept
/// exactly. The kinetic energy of rotation is split into that of a sphere and those of single principal axes,
/// |L|^2 / (2 I_c) + sum over i of (1 / I_i - 1 / I_c) L_i^2 / 2, I_c the middle moment: a turn about L, which commutes with
/// the others, and turns about two body axes, half of the one before and after the other. Explicit, second order,
/// symplectic and time-reversible; exact for a body with two equal moments and for a turn about one axis.
/// Source: Touma and Wisdom 1994; Dullweber, Leimkuhler and McLachlan 1997.
/// </summary>
internal static class FreeMotion<V>
    where V : struct, ILane<V>
{
    // Largest error of a quaternion's square.
    private const double MostStretch = 1e-10;

    // Cosine of half the most that a body may turn in a drift, 1.5 rad: three times what StepLimit lets it turn by its speed at the start.
    private const double LeastCosine = 0.7316888688738209;

    // Bodies of one island that turn side by side, and fewer of them for which it pays.
    private const int Together = 4;
    private const int LeastTogether = 3;

    /// <summary>Moves all moving bodies from X, Q to EndX, EndQ and fills R; and W with their mean rates, where scalar rows need them.</summary>
    public static void Drift(LaneRecords<V> batch, double h)
    {
        double[] a = batch.Bodies;
        Lane<V> step = Lane<V>.Splat(h);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = LaneRecords<V>.Body(body, 0);
            LaneVector<V> x = LaneVector<V>.Load(a, o, BodyLanes.X);
            (x + step * LaneVector<V>.Load(a, o, BodyLanes.V)).Store(a, o, BodyLanes.EndX);
        }

        RotationSplitting[] splittings = batch.Shape.RotationSplittings;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int alike = CountAlike(splittings, body, batch.Shape.MovingBodies);
            if (alike >= LeastTogether)
            {
                RotateTogether(a, body, alike, h, splittings[body], batch.Work.Turns);
                body += alike - 1;
            }
            else
            {
                Rotate(a, LaneRecords<V>.Body(body, 0), h, splittings[body]);
            }
        }

        foreach (int body in batch.Shape.MeanRateBodies)
        {
            MeasureMeanRate(a, LaneRecords<V>.Body(body, 0), h);
        }
    }

    /// <summary>Moves kinematic bodies at their velocities from X, Q to EndX, EndQ.</summary>
    public static void DriftKinematic(LaneRecords<V> batch, double h)
    {
        double[] a = batch.Bodies;
        Lane<V> step = Lane<V>.Splat(h);
        Lane<V> half = Lane<V>.Splat(h / 2);
        for (int body = batch.Shape.MovingBodies; body < batch.Shape.Bodies.Length; body++)
        {
            if (batch.Shape.IsStatic[body])
            {
                continue;
            }

            int o = LaneRecords<V>.Body(body, 0);
            LaneVector<V> x = LaneVector<V>.Load(a, o, BodyLanes.X);
            (x + step * LaneVector<V>.Load(a, o, BodyLanes.V)).Store(a, o, BodyLanes.EndX);
            LaneVector<V> rate = LaneVector<V>.Load(a, o, BodyLanes.W);
            LaneQuaternion<V> q = LaneQuaternion<V>.Exponential(half * rate) * LaneQuaternion<V>.Load(a, o, BodyLanes.Q);
            q = q.NearlyNormalized();
            q.Store(a, o, BodyLanes.EndQ);
            q.StoreMatrix(a, o, BodyLanes.R);
        }
    }

    /// <summary>Poses and matrices of the start as those of the end, for all bodies.</summary>
    public static void Stay(LaneRecords<V> batch)
    {
        double[] a = batch.Bodies;
        for (int body = 0; body < batch.Shape.Bodies.Length; body++)
        {
            int o = LaneRecords<V>.Body(body, 0);
            LaneVector<V>.Load(a, o, BodyLanes.X).Store(a, o, BodyLanes.EndX);
            LaneQuaternion<V> q = LaneQuaternion<V>.Load(a, o, BodyLanes.Q);
            q.Store(a, o, BodyLanes.EndQ);
            q.StoreMatrix(a, o, BodyLanes.R);
        }
    }

    /// <summary>Whether all turns of the last drift were narrow enough for the series: one too wide leaves a quaternion that is none. On the only lane.</summary>
    public static bool HasFollowed(LaneRecords<V> batch)
    {
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = LaneRecords<V>.Body(body, 0);
            double square = 0;
            for (int i = BodyLanes.EndQ; i < BodyLanes.EndQ + 4; i++)
            {
                square += batch.Bodies[o + i] * batch.Bodies[o + i];
            }

            if (!(Math.Abs(square - 1) < MostStretch))
            {
                return false;
            }
        }

        return true;
    }

    /// <summary>
    /// Whether a body of a lane turned so far in the last drift that the rows of locked angles no longer tell which way they are off: they are 0 at half a
    /// turn too.
    /// </summary>
    public static bool HasTurnedFar(LaneRecords<V> batch, int lane)
    {
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = LaneRecords<V>.Body(body, 0) + lane;
            double cosine = 0;
            for (int i = 0; i < 4; i++)
            {
                cosine += batch.Bodies[o + (BodyLanes.Q + i) * Lane<V>.Width] * batch.Bodies[o + (BodyLanes.EndQ + i) * Lane<V>.Width];
            }

            // Of half the turn.
            if (!(Math.Abs(cosine) > LeastCosine))
            {
                return true;
            }
        }

        return false;
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void MeasureMeanRate(double[] a, int o, double h)
    {
        LaneQuaternion<V> q = LaneQuaternion<V>.Load(a, o, BodyLanes.EndQ) * LaneQuaternion<V>.Load(a, o, BodyLanes.Q).Conjugate();
        (Lane<V>.Splat(1 / h) * q.RotationVector()).Store(a, o, BodyLanes.W);
    }

    /// <summary>
    /// Half the rate of the sphere's turn, rad/s: of a body that can exist no more than the angular speed, since the largest
    /// moment is at most the sum of the others; of one that cannot, it says how wide the single turns are.
    /// </summary>
    public static Lane<V> SphericalHalfRate(double[] bodies, int o, RotationSplitting splitting)
    {
        int w = Lane<V>.Width;
        LaneVector<V> momentum = LaneVector<V>.Load(bodies, o, BodyLanes.L);
        Lane<V> inverse = Lane<V>.Load(bodies, o + splitting.Spherical * w, BodyLanes.InverseInertia);
        return Lane<V>.Splat(0.5) * inverse * Lane<V>.Sqrt(LaneVector<V>.Dot(momentum, momentum));
    }

    // Up to so many bodies from one on that turn by the same formulas and may do so side by side: on the only lane, if the processor has others.
    private static int CountAlike(RotationSplitting[] splittings, int first, int count)
    {
        if (Lane<V>.Width > 1 || !Double4.CanTranspose)
        {
            return 1;
        }

        int alike = 1;
        while (alike < Together && first + alike < count && splittings[first + alike].Equals(splittings[first]))
        {
            alike++;
        }

        return alike;
    }

    // Fewer than four are joined by copies of the last.
    private static void RotateTogether(double[] a, int first, int count, double h, RotationSplitting splitting, double[] turns)
    {
        int o0 = LaneRecords<V>.Body(first, 0);
        int o1 = LaneRecords<V>.Body(first + Math.Min(1, count - 1), 0);
        int o2 = LaneRecords<V>.Body(first + Math.Min(2, count - 1), 0);
        int o3 = LaneRecords<V>.Body(first + count - 1, 0);
        Gather(a, o0, o1, o2, o3, BodyLanes.L, turns);
        Gather(a, o0, o1, o2, o3, BodyLanes.Q + 1, turns);
        Gather(a, o0, o1, o2, o3, BodyLanes.InverseInertia, turns);
#if NET
        FreeMotion<Lane4>.Rotate(turns, 0, h, splitting);
#endif
        Scatter(turns, BodyLanes.EndQ, a, o0, o1, o2, o3);
        Scatter(turns, BodyLanes.R, a, o0, o1, o2, o3);
        Scatter(turns, BodyLanes.R + 4, a, o0, o1, o2, o3);
        const int last = BodyLanes.R + 8;
        a[o0 + last] = turns[Together * last];
        a[o1 + last] = turns[Together * last + 1];
        a[o2 + last] = turns[Together * last + 2];
        a[o3 + last] = turns[Together * last + 3];
    }

    // Four numbers of each body, from a slot on, as a record in lanes has them.
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static void Gather(double[] a, int o0, int o1, int o2, int o3, int slot, double[] turns)
    {
        Double4 x = Double4.Load(a, o0 + slot), y = Double4.Load(a, o1 + slot), z = Double4.Load(a, o2 + slot), w = Double4.Load(a, o3 + slot);
        Double4.Transpose(ref x, ref y, ref z, ref w);
        x.Store(turns, Together * slot);
        y.Store(turns, Together * (slot + 1));
        z.Store(turns, Together * (slot + 2));
        w.Store(turns, Together * (slot + 3));
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static void Scatter(double[] turns, int slot, double[] a, int o0, int o1, int o2, int o3)
    {
        Double4 x = Double4.Load(turns, Together * slot), y = Double4.Load(turns, Together * (slot + 1));
        Double4 z = Double4.Load(turns, Together * (slot + 2)), w = Double4.Load(turns, Together * (slot + 3));
        Double4.Transpose(ref x, ref y, ref z, ref w);
        x.Store(a, o0 + slot);
        y.Store(a, o1 + slot);
        z.Store(a, o2 + slot);
        w.Store(a, o3 + slot);
    }

    // Body axes are taken in the cyclic order that puts the sphere's axis last; a cyclic relabelling of the world's axes too
    // leaves all formulas as they are. Each turn is a method of its own, small enough that the compiler inlines its arithmetic.
    internal static void Rotate(double[] a, int o, double h, RotationSplitting splitting)
    {
        RotateSpherical(a, o, h / 2, splitting.Spherical);
        if (splitting.IsBDistinct)
        {
            MomentumToBody(a, o, splitting);
            RotateAboutA(a, o, h / 4, splitting);
            RotateAboutB(a, o, h / 2, splitting);
            RotateAboutA(a, o, h / 4, splitting);
        }
        else if (splitting.IsADistinct)
        {
            MomentumToBody(a, o, splitting);
            RotateAboutA(a, o, h / 2, splitting);
        }

        Normalise(a, o);
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void RotateSpherical(double[] a, int o, double half, int axis)
    {
        int w = Lane<V>.Width;
        Lane<V> inverse = Lane<V>.Splat(half) * Lane<V>.Load(a, o + axis * w, BodyLanes.InverseInertia);
        LaneVector<V> u = inverse * LaneVector<V>.Load(a, o, BodyLanes.L);
        Lane<V> square = LaneVector<V>.Dot(u, u);
        Lane<V> c = LaneQuaternion<V>.CosineSeries(square);
        LaneVector<V> s = LaneQuaternion<V>.SineSeries(square) * u;
        LaneVector<V> v = LaneVector<V>.Load(a, o, BodyLanes.Q);
        Lane<V> scalar = Lane<V>.Load(a, o, BodyLanes.Q + 3);
        (c * v + scalar * s + LaneVector<V>.Cross(s, v)).Store(a, o, BodyLanes.EndQ);
        (c * scalar - LaneVector<V>.Dot(s, v)).Store(a, o, BodyLanes.EndQ + 3);
    }

    // L in the body's axes at the start, in the order first, second, sphere.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void MomentumToBody(double[] a, int o, RotationSplitting splitting)
    {
        int w = Lane<V>.Width;
        LaneVector<V> local = LaneQuaternion<V>.Load(a, o, BodyLanes.Q).InverseRotate(LaneVector<V>.Load(a, o, BodyLanes.L));
        local.Store(a, o, BodyLanes.BodyMomentum);
        Permuted(a, o + BodyLanes.BodyMomentum * w, splitting).Store(a, o, BodyLanes.BodyMomentum);
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void RotateAboutA(double[] a, int o, double half, RotationSplitting splitting)
    {
        int w = Lane<V>.Width;
        LaneVector<V> local = LaneVector<V>.Load(a, o, BodyLanes.BodyMomentum);
        Lane<V> angle = Lane<V>.Splat(half) * Excess(a, o, splitting.AxisA, splitting) * local.X;
        HalfAngle(angle, out Lane<V> s, out Lane<V> c);
        LaneVector<V> v = Permuted(a, o + BodyLanes.EndQ * w, splitting);
        Lane<V> scalar = Lane<V>.Load(a, o, BodyLanes.EndQ + 3);
        StorePermuted(new LaneVector<V>(c * v.X + s * scalar, c * v.Y + s * v.Z, c * v.Z - s * v.Y), a, o + BodyLanes.EndQ * w, splitting);
        (c * scalar - s * v.X).Store(a, o, BodyLanes.EndQ + 3);

        // L is fixed in the world: in the body it turns the other way, by the whole angle.
        Lane<V> sine = (s + s) * c;
        Lane<V> cosine = c * c - s * s;
        (cosine * local.Y + sine * local.Z).Store(a, o, BodyLanes.BodyMomentum + 1);
        (cosine * local.Z - sine * local.Y).Store(a, o, BodyLanes.BodyMomentum + 2);
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void RotateAboutB(double[] a, int o, double half, RotationSplitting splitting)
    {
        int w = Lane<V>.Width;
        LaneVector<V> local = LaneVector<V>.Load(a, o, BodyLanes.BodyMomentum);
        Lane<V> angle = Lane<V>.Splat(half) * Excess(a, o, splitting.AxisB, splitting) * local.Y;
        HalfAngle(angle, out Lane<V> s, out Lane<V> c);
        LaneVector<V> v = Permuted(a, o + BodyLanes.EndQ * w, splitting);
        Lane<V> scalar = Lane<V>.Load(a, o, BodyLanes.EndQ + 3);
        StorePermuted(new LaneVector<V>(c * v.X - s * v.Z, c * v.Y + s * scalar, c * v.Z + s * v.X), a, o + BodyLanes.EndQ * w, splitting);
        (c * scalar - s * v.Y).Store(a, o, BodyLanes.EndQ + 3);
        Lane<V> sine = (s + s) * c;
        Lane<V> cosine = c * c - s * s;
        (cosine * local.X - sine * local.Z).Store(a, o, BodyLanes.BodyMomentum);
        (cosine * local.Z + sine * local.X).Store(a, o, BodyLanes.BodyMomentum + 2);
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void Normalise(double[] a, int o)
    {
        LaneQuaternion<V> q = LaneQuaternion<V>.Load(a, o, BodyLanes.EndQ).NearlyNormalized();
        q.Store(a, o, BodyLanes.EndQ);
        q.StoreMatrix(a, o, BodyLanes.R);
    }

    // 1 / I of an axis less that of the sphere's.
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static Lane<V> Excess(double[] a, int o, int axis, RotationSplitting splitting)
    {
        int w = Lane<V>.Width;
        return Lane<V>.Load(a, o + axis * w, BodyLanes.InverseInertia) - Lane<V>.Load(a, o + splitting.Spherical * w, BodyLanes.InverseInertia);
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static LaneVector<V> Permuted(double[] a, int at, RotationSplitting splitting)
    {
        int w = Lane<V>.Width;
        return new LaneVector<V>(Lane<V>.Load(a, at + splitting.AxisA * w), Lane<V>.Load(a, at + splitting.AxisB * w), Lane<V>.Load(a, at + splitting.Spherical * w));
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static void StorePermuted(LaneVector<V> v, double[] a, int at, RotationSplitting splitting)
    {
        int w = Lane<V>.Width;
        v.X.Store(a, at + splitting.AxisA * w);
        v.Y.Store(a, at + splitting.AxisB * w);
        v.Z.Store(a, at + splitting.Spherical * w);
    }

    // Sine and cosine of half the angle of a turn, from that half.
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static void HalfAngle(Lane<V> half, out Lane<V> sine, out Lane<V> cosine)
    {
        Lane<V> square = half * half;
        sine = half * LaneQuaternion<V>.SineSeries(square);
        cosine = LaneQuaternion<V>.CosineSeries(square);
    }
}
