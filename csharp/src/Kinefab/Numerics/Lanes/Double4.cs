using System.Runtime.CompilerServices;
#if NET
using System.Runtime.Intrinsics;
using System.Runtime.Intrinsics.X86;
#endif

namespace Kinefab.Numerics;

/// <summary>
/// Four doubles side by side, so that a three-vector and one number more are handled in one go where the processor can. The
/// same operations in the same order on every target: + - * and no fused ones.
/// </summary>
internal readonly struct Double4
{
#if NET
    private readonly Vector256<double> _v;

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private Double4(Vector256<double> v) => _v = v;

    public Double4(Vector3d v, double w) => _v = Vector256.Create(v.X, v.Y, v.Z, w);

    /// <summary>The fourth number.</summary>
    public double W => _v.GetElement(3);

    /// <summary>The first three.</summary>
    public Vector3d Vector => new(_v.GetElement(0), _v.GetElement(1), _v.GetElement(2));

    /// <summary>The same with another fourth number.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Double4 With(double w) => new(Vector256.ConditionalSelect(Vector256.Create(-1L, -1L, -1L, 0L).AsDouble(), _v, Vector256.Create(w)));

    /// <summary>Sum of the first three.</summary>
    public double Sum3
    {
        [MethodImpl(MethodImplOptions.AggressiveInlining)]
        get
        {
            Vector128<double> low = _v.GetLower();
            return low.ToScalar() + low.GetElement(1) + _v.GetUpper().ToScalar();
        }
    }

    /// <summary>Four numbers from an index on, which the caller knows to be there: only the first is checked.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Double4 Load(double[] values, int index) => new(Vector256.LoadUnsafe(ref values[index]));

    /// <summary>Likewise.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public void Store(double[] values, int index) => _v.StoreUnsafe(ref values[index]);

    /// <summary>One of its numbers, four times.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Double4 Spread(int i)
    {
        if (!Avx.IsSupported)
        {
            return new(Vector256.Create(_v.GetElement(i)));
        }

        // Its half twice, then within the halves: all four are there at the same time, which half by half they are not.
        Vector256<double> half = i < 2 ? Avx.Permute2x128(_v, _v, 0x00) : Avx.Permute2x128(_v, _v, 0x11);
        return new(i % 2 == 0 ? Avx.UnpackLow(half, half) : Avx.UnpackHigh(half, half));
    }

    /// <summary>Sum of the first three of each.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Double4 Sums3(Double4 a, Double4 b, Double4 c, Double4 d)
    {
        if (!Avx.IsSupported)
        {
            return new(Vector256.Create(a.Sum3, b.Sum3, c.Sum3, d.Sum3));
        }

        // Transposed: x and z of a pair are in the low halves' interleaving, y in the high halves'.
        Vector256<double> ab = Avx.UnpackLow(a._v, b._v);
        Vector256<double> cd = Avx.UnpackLow(c._v, d._v);
        Vector256<double> y = Avx.Permute2x128(Avx.UnpackHigh(a._v, b._v), Avx.UnpackHigh(c._v, d._v), 0x20);
        return new(Avx.Permute2x128(ab, cd, 0x20) + y + Avx.Permute2x128(ab, cd, 0x31));
    }

    /// <summary>Whether <see cref="Transpose"/> is there.</summary>
    public static bool CanTranspose => Avx.IsSupported;

    /// <summary>Rows become columns.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static void Transpose(ref Double4 a, ref Double4 b, ref Double4 c, ref Double4 d)
    {
        Vector256<double> evenAb = Avx.UnpackLow(a._v, b._v);
        Vector256<double> oddAb = Avx.UnpackHigh(a._v, b._v);
        Vector256<double> evenCd = Avx.UnpackLow(c._v, d._v);
        Vector256<double> oddCd = Avx.UnpackHigh(c._v, d._v);
        a = new(Avx.Permute2x128(evenAb, evenCd, 0x20));
        b = new(Avx.Permute2x128(oddAb, oddCd, 0x20));
        c = new(Avx.Permute2x128(evenAb, evenCd, 0x31));
        d = new(Avx.Permute2x128(oddAb, oddCd, 0x31));
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Double4 operator +(in Double4 a, in Double4 b) => new(a._v + b._v);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Double4 operator -(in Double4 a, in Double4 b) => new(a._v - b._v);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Double4 operator *(in Double4 a, in Double4 b) => new(a._v * b._v);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Double4 operator *(in Double4 a, double s) => new(a._v * Vector256.Create(s));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Double4 operator *(double s, in Double4 a) => new(Vector256.Create(s) * a._v);
#else
    private readonly double _x, _y, _z, _w;

    private Double4(double x, double y, double z, double w)
    {
        _x = x;
        _y = y;
        _z = z;
        _w = w;
    }

    public Double4(Vector3d v, double w)
        : this(v.X, v.Y, v.Z, w)
    {
    }

    /// <summary>The fourth number.</summary>
    public double W => _w;

    /// <summary>The first three.</summary>
    public Vector3d Vector => new(_x, _y, _z);

    /// <summary>The same with another fourth number.</summary>
    public Double4 With(double w) => new(_x, _y, _z, w);

    /// <summary>Sum of the first three.</summary>
    public double Sum3 => _x + _y + _z;

    public static Double4 Load(double[] values, int index) => new(values[index], values[index + 1], values[index + 2], values[index + 3]);

    public void Store(double[] values, int index)
    {
        values[index] = _x;
        values[index + 1] = _y;
        values[index + 2] = _z;
        values[index + 3] = _w;
    }

    /// <summary>One of its numbers, four times.</summary>
    public Double4 Spread(int i)
    {
        double v = i == 0 ? _x : i == 1 ? _y : i == 2 ? _z : _w;
        return new Double4(v, v, v, v);
    }

    /// <summary>Whether <see cref="Transpose"/> is there: it pays by the processor's own instruction alone.</summary>
    public static bool CanTranspose => false;

    public static void Transpose(ref Double4 a, ref Double4 b, ref Double4 c, ref Double4 d) => throw new System.NotSupportedException();

    /// <summary>Sum of the first three of each.</summary>
    public static Double4 Sums3(Double4 a, Double4 b, Double4 c, Double4 d) => new(a.Sum3, b.Sum3, c.Sum3, d.Sum3);

    public static Double4 operator +(in Double4 a, in Double4 b) => new(a._x + b._x, a._y + b._y, a._z + b._z, a._w + b._w);

    public static Double4 operator -(in Double4 a, in Double4 b) => new(a._x - b._x, a._y - b._y, a._z - b._z, a._w - b._w);

    public static Double4 operator *(in Double4 a, in Double4 b) => new(a._x * b._x, a._y * b._y, a._z * b._z, a._w * b._w);

    public static Double4 operator *(in Double4 a, double s) => new(a._x * s, a._y * s, a._z * s, a._w * s);

    public static Double4 operator *(double s, in Double4 a) => new(s * a._x, s * a._y, s * a._z, s * a._w);
#endif
}
