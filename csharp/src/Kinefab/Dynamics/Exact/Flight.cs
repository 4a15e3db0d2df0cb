using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>
/// Motion of each body under its own momentum over a step h: x' = x + h v, and rotation with the angular momentum L kept
/// exactly. The kinetic energy of rotation is split into that of a sphere and those of single principal axes,
/// |L|^2 / (2 I_c) + sum over i of (1 / I_i - 1 / I_c) L_i^2 / 2, I_c the middle moment: a turn about L, which commutes with
/// the others, and turns about two body axes, half of the one before and after the other. Explicit, second order,
/// symplectic and time-reversible; exact for a body with two equal moments and for a turn about one axis.
/// Source: Touma and Wisdom 1994; Dullweber, Leimkuhler and McLachlan 1997.
/// </summary>
internal static class Flight<V>
    where V : struct, ILane<V>
{
    /// <summary>Moves all moving bodies from X, Q to EndX, EndQ and fills R; and W with their mean rates, where laws need them.</summary>
    public static void Run(Batch<V> batch, double h)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        Lane<V> step = Lane<V>.Splat(h);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = Batch<V>.Body(body, 0);
            LaneVector<V> x = LaneVector<V>.Load(a, o + BodySlot.X * w);
            (x + step * LaneVector<V>.Load(a, o + BodySlot.V * w)).Store(a, o + BodySlot.EndX * w);
            Turn(a, o, h, batch.Shape.Spins[body]);
        }

        if (batch.Laws != null)
        {
            MeanRates(batch, h);
        }
    }

    /// <summary>Moves kinematic bodies at their velocities from X, Q to EndX, EndQ.</summary>
    public static void MoveKinematic(Batch<V> batch, double h)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        Lane<V> step = Lane<V>.Splat(h);
        Lane<V> half = Lane<V>.Splat(h / 2);
        for (int body = batch.Shape.MovingBodies; body < batch.Shape.Bodies.Length; body++)
        {
            if (batch.Shape.IsStatic[body])
            {
                continue;
            }

            int o = Batch<V>.Body(body, 0);
            LaneVector<V> x = LaneVector<V>.Load(a, o + BodySlot.X * w);
            (x + step * LaneVector<V>.Load(a, o + BodySlot.V * w)).Store(a, o + BodySlot.EndX * w);
            LaneVector<V> rate = LaneVector<V>.Load(a, o + BodySlot.W * w);
            LaneQuaternion<V> q = LaneQuaternion<V>.Exponential(half * rate) * LaneQuaternion<V>.Load(a, o + BodySlot.Q * w);
            q = q.NearlyNormalized();
            q.Store(a, o + BodySlot.EndQ * w);
            q.StoreMatrix(a, o + BodySlot.R * w);
        }
    }

    /// <summary>Poses and matrices of the start as those of the end, for all bodies.</summary>
    public static void Stay(Batch<V> batch)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        for (int body = 0; body < batch.Shape.Bodies.Length; body++)
        {
            int o = Batch<V>.Body(body, 0);
            LaneVector<V>.Load(a, o + BodySlot.X * w).Store(a, o + BodySlot.EndX * w);
            LaneQuaternion<V> q = LaneQuaternion<V>.Load(a, o + BodySlot.Q * w);
            q.Store(a, o + BodySlot.EndQ * w);
            q.StoreMatrix(a, o + BodySlot.R * w);
        }
    }

    private static void MeanRates(Batch<V> batch, double h)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = Batch<V>.Body(body, 0);
            LaneQuaternion<V> q = LaneQuaternion<V>.Load(a, o + BodySlot.EndQ * w) * LaneQuaternion<V>.Load(a, o + BodySlot.Q * w).Conjugate();
            (Lane<V>.Splat(1 / h) * q.RotationVector()).Store(a, o + BodySlot.W * w);
        }
    }

    // Body axes are taken in the cyclic order that puts the sphere's axis last; a cyclic relabelling of the world's axes too
    // leaves all formulas as they are.
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static void Turn(double[] a, int o, double h, Spin spin)
    {
        int w = Lane<V>.Width;
        int i = spin.First * w, j = spin.Second * w, k = spin.Sphere * w;
        int at = o + BodySlot.Q * w;
        var q = new LaneQuaternion<V>(Load(a, at, i, j, k), Lane<V>.Load(a, at + 3 * w));
        LaneVector<V> momentum = Load(a, o + BodySlot.L * w, i, j, k);
        LaneVector<V> inverse = Load(a, o + BodySlot.InverseInertia * w, i, j, k);
        LaneQuaternion<V> turned = LaneQuaternion<V>.Exponential(Lane<V>.Splat(h / 2) * inverse.Z * momentum) * q;
        if (spin.IsFirstOther)
        {
            LaneVector<V> local = q.InverseRotate(momentum);
            Lane<V> first = inverse.X - inverse.Z;
            if (spin.IsSecondOther)
            {
                Lane<V> quarter = Lane<V>.Splat(h / 4);
                Axial(quarter * first * local.X, out Lane<V> s, out Lane<V> c);
                turned = turned.TurnedAboutX(s, c);
                local = AgainstX(local, s, c);
                Axial(Lane<V>.Splat(h / 2) * (inverse.Y - inverse.Z) * local.Y, out s, out c);
                turned = turned.TurnedAboutY(s, c);
                Lane<V> x = AgainstY(local, s, c);
                Axial(quarter * first * x, out s, out c);
                turned = turned.TurnedAboutX(s, c);
            }
            else
            {
                Axial(Lane<V>.Splat(h / 2) * first * local.X, out Lane<V> s, out Lane<V> c);
                turned = turned.TurnedAboutX(s, c);
            }
        }

        turned = turned.NearlyNormalized();
        at = o + BodySlot.EndQ * w;
        turned.Vector.X.Store(a, at + i);
        turned.Vector.Y.Store(a, at + j);
        turned.Vector.Z.Store(a, at + k);
        turned.W.Store(a, at + 3 * w);
        LaneQuaternion<V>.Load(a, at).StoreMatrix(a, o + BodySlot.R * w);
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static LaneVector<V> Load(double[] a, int at, int i, int j, int k) =>
        new(Lane<V>.Load(a, at + i), Lane<V>.Load(a, at + j), Lane<V>.Load(a, at + k));

    // Sine and cosine of half the angle of a turn.
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static void Axial(Lane<V> half, out Lane<V> sine, out Lane<V> cosine)
    {
        Lane<V> square = half * half;
        sine = half * LaneQuaternion<V>.SineSeries(square);
        cosine = LaneQuaternion<V>.CosineSeries(square);
    }

    // A vector fixed in the world, seen from a body that turned about its x axis (y axis: its x component alone).
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static LaneVector<V> AgainstX(LaneVector<V> v, Lane<V> s, Lane<V> c)
    {
        Lane<V> sine = (s + s) * c;
        Lane<V> cosine = c * c - s * s;
        return new LaneVector<V>(v.X, cosine * v.Y + sine * v.Z, cosine * v.Z - sine * v.Y);
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static Lane<V> AgainstY(LaneVector<V> v, Lane<V> s, Lane<V> c) => (c * c - s * s) * v.X - (s + s) * c * v.Z;
}
