using System;
using System.Runtime.CompilerServices;

namespace Kinefab.Numerics;

/// <summary>Three numbers a lane; stored one after the other, each Width doubles wide.</summary>
internal readonly struct LaneVector<V>
    where V : struct, ILane<V>
{
    public readonly Lane<V> X;
    public readonly Lane<V> Y;
    public readonly Lane<V> Z;

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public LaneVector(Lane<V> x, Lane<V> y, Lane<V> z)
    {
        X = x;
        Y = y;
        Z = z;
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneVector<V> Load(double[] array, int index, int skip = 0) => new(
        Lane<V>.Load(array, index, skip),
        Lane<V>.Load(array, index, skip + 1),
        Lane<V>.Load(array, index, skip + 2));

    /// <summary>For each lane the vector with its number: see <see cref="ILane{TSelf}.Gather"/>.</summary>
    /// <param name="from">Vectors, three numbers each.</param>
    /// <param name="records">For each lane the number of its vector.</param>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneVector<V> Gather(ReadOnlySpan<double> from, ReadOnlySpan<int> records) => new(
        Lane<V>.Gather(from, records, 3, 0),
        Lane<V>.Gather(from, records, 3, 1),
        Lane<V>.Gather(from, records, 3, 2));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public void Store(double[] array, int index, int skip = 0)
    {
        X.Store(array, index, skip);
        Y.Store(array, index, skip + 1);
        Z.Store(array, index, skip + 2);
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> Dot(LaneVector<V> a, LaneVector<V> b) => a.X * b.X + a.Y * b.Y + a.Z * b.Z;

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneVector<V> Cross(LaneVector<V> a, LaneVector<V> b) =>
        new(a.Y * b.Z - a.Z * b.Y, a.Z * b.X - a.X * b.Z, a.X * b.Y - a.Y * b.X);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneVector<V> Scale(LaneVector<V> a, LaneVector<V> b) => new(a.X * b.X, a.Y * b.Y, a.Z * b.Z);

    /// <summary>A vector times the symmetric matrix that stands at the index: xx, yy, zz, xy, xz, yz.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneVector<V> Transform(double[] array, int index, int skip, LaneVector<V> v)
    {
        Lane<V> xy = Lane<V>.Load(array, index, skip + 3);
        Lane<V> xz = Lane<V>.Load(array, index, skip + 4);
        Lane<V> yz = Lane<V>.Load(array, index, skip + 5);
        return new LaneVector<V>(
            Lane<V>.Load(array, index, skip) * v.X + xy * v.Y + xz * v.Z,
            xy * v.X + Lane<V>.Load(array, index, skip + 1) * v.Y + yz * v.Z,
            xz * v.X + yz * v.Y + Lane<V>.Load(array, index, skip + 2) * v.Z);
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneVector<V> Select(Lane<V> mask, LaneVector<V> first, LaneVector<V> second) => new(
        Lane<V>.Select(mask, first.X, second.X),
        Lane<V>.Select(mask, first.Y, second.Y),
        Lane<V>.Select(mask, first.Z, second.Z));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneVector<V> operator +(LaneVector<V> a, LaneVector<V> b) => new(a.X + b.X, a.Y + b.Y, a.Z + b.Z);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneVector<V> operator -(LaneVector<V> a, LaneVector<V> b) => new(a.X - b.X, a.Y - b.Y, a.Z - b.Z);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneVector<V> operator -(LaneVector<V> a)
    {
        Lane<V> zero = Lane<V>.Splat(0);
        return new LaneVector<V>(zero - a.X, zero - a.Y, zero - a.Z);
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneVector<V> operator *(Lane<V> s, LaneVector<V> a) => new(s * a.X, s * a.Y, s * a.Z);
}

/// <summary>A quaternion a lane, xyzw.</summary>
internal readonly struct LaneQuaternion<V>
    where V : struct, ILane<V>
{
    public readonly LaneVector<V> Vector;
    public readonly Lane<V> W;

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public LaneQuaternion(LaneVector<V> vector, Lane<V> w)
    {
        Vector = vector;
        W = w;
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneQuaternion<V> Load(double[] array, int index, int skip) =>
        new(LaneVector<V>.Load(array, index, skip), Lane<V>.Load(array, index, skip + 3));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public void Store(double[] array, int index, int skip)
    {
        Vector.Store(array, index, skip);
        W.Store(array, index, skip + 3);
    }

    /// <summary>First b, then a.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneQuaternion<V> operator *(LaneQuaternion<V> a, LaneQuaternion<V> b) => new(
        a.W * b.Vector + b.W * a.Vector + LaneVector<V>.Cross(a.Vector, b.Vector),
        a.W * b.W - LaneVector<V>.Dot(a.Vector, b.Vector));

    /// <summary>The vector turned by a unit quaternion.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public LaneVector<V> Rotate(LaneVector<V> v)
    {
        LaneVector<V> t = Lane<V>.Splat(2) * LaneVector<V>.Cross(Vector, v);
        return v + W * t + LaneVector<V>.Cross(Vector, t);
    }

    /// <summary>The vector turned by a unit quaternion's inverse.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public LaneVector<V> InverseRotate(LaneVector<V> v)
    {
        LaneVector<V> t = Lane<V>.Splat(2) * LaneVector<V>.Cross(Vector, v);
        return v - W * t + LaneVector<V>.Cross(Vector, t);
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public LaneQuaternion<V> Conjugate() => new(-Vector, W);

    /// <summary>
    /// The rotation by the vector 2 u: (u sin|u|/|u|, cos|u|) by the Taylor series, so that no library's sine decides the
    /// last bit. For |u| up to 1/2 the first term left out is below 1e-14.
    /// </summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneQuaternion<V> Exponential(LaneVector<V> u)
    {
        Lane<V> s = LaneVector<V>.Dot(u, u);
        return new LaneQuaternion<V>(SineSeries(s) * u, CosineSeries(s));
    }

    /// <summary>sin(x)/x of x^2. Terms in pairs, which are there at the same time: one after the other each would wait for the one before it.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> SineSeries(Lane<V> s)
    {
        Lane<V> square = s * s;
        Lane<V> low = Lane<V>.Splat(1) - s * Lane<V>.Splat(1.0 / 6);
        Lane<V> middle = Lane<V>.Splat(1.0 / 120) - s * Lane<V>.Splat(1.0 / 5040);
        Lane<V> high = Lane<V>.Splat(1.0 / 362880) - s * Lane<V>.Splat(1.0 / 39916800);
        return low + square * (middle + square * high);
    }

    /// <summary>cos(x) of x^2, likewise.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> CosineSeries(Lane<V> s)
    {
        Lane<V> square = s * s;
        Lane<V> low = Lane<V>.Splat(1) - s * Lane<V>.Splat(1.0 / 2);
        Lane<V> middle = Lane<V>.Splat(1.0 / 24) - s * Lane<V>.Splat(1.0 / 720);
        Lane<V> high = Lane<V>.Splat(1.0 / 40320) - s * Lane<V>.Splat(1.0 / 3628800);
        return low + square * (middle + square * (high + square * Lane<V>.Splat(1.0 / 479001600)));
    }

    /// <summary>
    /// The vector by which it turns, for a turn by up to 1 rad: two half turns' quotients shorten it to a quarter, whose
    /// arcsine is a series. The first term left out is below 1e-13.
    /// </summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public LaneVector<V> RotationVector()
    {
        LaneVector<V> quarter = Half().Half().Vector;
        Lane<V> s = LaneVector<V>.Dot(quarter, quarter);
        Lane<V> arcsine = Lane<V>.Splat(1) + s * (Lane<V>.Splat(1.0 / 6) + s * (Lane<V>.Splat(3.0 / 40) + s * (Lane<V>.Splat(15.0 / 336)
            + s * (Lane<V>.Splat(105.0 / 3456) + s * (Lane<V>.Splat(945.0 / 42240) + s * Lane<V>.Splat(10395.0 / 599040))))));
        return Lane<V>.Splat(8) * arcsine * quarter;
    }

    /// <summary>One Newton step towards length 1, from a length next to it.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public LaneQuaternion<V> NearlyNormalized()
    {
        Lane<V> scale = Lane<V>.Splat(1.5) - Lane<V>.Splat(0.5) * (LaneVector<V>.Dot(Vector, Vector) + W * W);
        return new LaneQuaternion<V>(scale * Vector, scale * W);
    }

    /// <summary>Writes the rotation matrix, row-major.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public void StoreMatrix(double[] array, int index, int skip)
    {
        Lane<V> one = Lane<V>.Splat(1);
        Lane<V> x2 = Vector.X + Vector.X, y2 = Vector.Y + Vector.Y, z2 = Vector.Z + Vector.Z;
        Lane<V> xx = x2 * Vector.X, yy = y2 * Vector.Y, zz = z2 * Vector.Z;
        Lane<V> xy = x2 * Vector.Y, xz = x2 * Vector.Z, yz = y2 * Vector.Z;
        Lane<V> xw = x2 * W, yw = y2 * W, zw = z2 * W;
        new LaneVector<V>(one - yy - zz, xy - zw, xz + yw).Store(array, index, skip);
        new LaneVector<V>(xy + zw, one - xx - zz, yz - xw).Store(array, index, skip + 3);
        new LaneVector<V>(xz - yw, yz + xw, one - xx - yy).Store(array, index, skip + 6);
    }

    // The rotation by half the angle: (v, 1 + w) brought to length 1.
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private LaneQuaternion<V> Half()
    {
        Lane<V> w = Lane<V>.Splat(1) + W;
        Lane<V> scale = Lane<V>.Splat(1) / Lane<V>.Sqrt(LaneVector<V>.Dot(Vector, Vector) + w * w);
        return new LaneQuaternion<V>(scale * Vector, scale * w);
    }
}
