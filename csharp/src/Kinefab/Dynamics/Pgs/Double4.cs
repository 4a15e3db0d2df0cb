using System.Runtime.CompilerServices;
#if NET
using System.Runtime.Intrinsics;
#endif
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

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

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Double4 operator +(Double4 a, Double4 b) => new(a._v + b._v);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Double4 operator -(Double4 a, Double4 b) => new(a._v - b._v);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Double4 operator *(Double4 a, Double4 b) => new(a._v * b._v);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Double4 operator *(Double4 a, double s) => new(a._v * Vector256.Create(s));
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

    /// <summary>Sum of the first three.</summary>
    public double Sum3 => _x + _y + _z;

    public static Double4 operator +(Double4 a, Double4 b) => new(a._x + b._x, a._y + b._y, a._z + b._z, a._w + b._w);

    public static Double4 operator -(Double4 a, Double4 b) => new(a._x - b._x, a._y - b._y, a._z - b._z, a._w - b._w);

    public static Double4 operator *(Double4 a, Double4 b) => new(a._x * b._x, a._y * b._y, a._z * b._z, a._w * b._w);

    public static Double4 operator *(Double4 a, double s) => new(a._x * s, a._y * s, a._z * s, a._w * s);
#endif
}
