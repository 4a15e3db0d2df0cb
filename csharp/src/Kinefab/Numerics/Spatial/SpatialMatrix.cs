using System.Runtime.CompilerServices;

namespace Kinefab.Numerics;

/// <summary>
/// A symmetric 6 x 6 matrix in blocks of 3 x 3, [A B; B^T C], each by its columns. As an inertia it makes the wrench (force, torque) of the
/// motion (linear, angular); as a response it makes the motion (angular, linear) of the impulse (torque, force). In these two orders moving to
/// another point is the same formula.
/// </summary>
internal struct SpatialMatrix
{
    private Vector3d _a0, _a1, _a2;
    private Vector3d _b0, _b1, _b2;
    private Vector3d _c0, _c1, _c2;

    /// <summary>A link by itself: m about its centre of mass, R diag(moments) R^T.</summary>
    public static SpatialMatrix Inertia(double mass, Vector3d moments, Quaterniond q)
    {
        double xx = 2 * q.X * q.X, yy = 2 * q.Y * q.Y, zz = 2 * q.Z * q.Z;
        double xy = 2 * q.X * q.Y, xz = 2 * q.X * q.Z, yz = 2 * q.Y * q.Z;
        double wx = 2 * q.W * q.X, wy = 2 * q.W * q.Y, wz = 2 * q.W * q.Z;
        var x = new Vector3d(1 - (yy + zz), xy + wz, xz - wy);
        var y = new Vector3d(xy - wz, 1 - (xx + zz), yz + wx);
        var z = new Vector3d(xz + wy, yz - wx, 1 - (xx + yy));
        Vector3d u = x * moments.X, v = y * moments.Y, w = z * moments.Z;
        return new SpatialMatrix
        {
            _a0 = new Vector3d(mass, 0, 0),
            _a1 = new Vector3d(0, mass, 0),
            _a2 = new Vector3d(0, 0, mass),
            _c0 = u * x.X + v * y.X + w * z.X,
            _c1 = u * x.Y + v * y.Y + w * z.Y,
            _c2 = u * x.Z + v * y.Z + w * z.Z,
        };
    }

    /// <summary>The wrench that gives an inertia this acceleration.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public readonly Wrench Times(in Twist a) => new(
        Product(_a0, _a1, _a2, a.Linear) + Product(_b0, _b1, _b2, a.Angular),
        Transposed(_b0, _b1, _b2, a.Linear) + Product(_c0, _c1, _c2, a.Angular));

    /// <summary>The change of motion that an impulse gives by this response.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public readonly Twist Times(in Wrench p) => new(
        Product(_a0, _a1, _a2, p.Torque) + Product(_b0, _b1, _b2, p.Force),
        Transposed(_b0, _b1, _b2, p.Torque) + Product(_c0, _c1, _c2, p.Force));

    /// <summary>An inertia of the point r away from where it shall be seen, there.</summary>
    public readonly SpatialMatrix From(Vector3d r)
    {
        SpatialMatrix sum = default;
        sum.AddFrom(this, r);
        return sum;
    }

    /// <summary>Plus an inertia of the point r away from this one's.</summary>
    public void AddFrom(in SpatialMatrix m, Vector3d r)
    {
        // [A, B - A r~; ., C + r~ B' + (r~ B)^T] with B' = B - A r~; column i of A r~ is A (r x e_i).
        Vector3d b0 = m._b0 - (m._a1 * r.Z - m._a2 * r.Y);
        Vector3d b1 = m._b1 - (m._a2 * r.X - m._a0 * r.Z);
        Vector3d b2 = m._b2 - (m._a0 * r.Y - m._a1 * r.X);
        Vector3d p0 = Vector3d.Cross(r, m._b0), p1 = Vector3d.Cross(r, m._b1), p2 = Vector3d.Cross(r, m._b2);
        _a0 += m._a0;
        _a1 += m._a1;
        _a2 += m._a2;
        _b0 += b0;
        _b1 += b1;
        _b2 += b2;
        _c0 += m._c0 + Vector3d.Cross(r, b0) + new Vector3d(p0.X, p1.X, p2.X);
        _c1 += m._c1 + Vector3d.Cross(r, b1) + new Vector3d(p0.Y, p1.Y, p2.Y);
        _c2 += m._c2 + Vector3d.Cross(r, b2) + new Vector3d(p0.Z, p1.Z, p2.Z);
    }

    /// <summary>Less u u^T s, of an inertia.</summary>
    public void Subtract(in Wrench u, double s) => AddOuter(u.Force, u.Torque, u.Force * -s, u.Torque * -s);

    /// <summary>Less (u v^T + v u^T) / 2, of an inertia; v = u s gives <see cref="Subtract"/>.</summary>
    public void SubtractBoth(in Wrench u, in Wrench v)
    {
        AddOuter(u.Force, u.Torque, v.Force * -0.5, v.Torque * -0.5);
        AddOuter(v.Force, v.Torque, u.Force * -0.5, u.Torque * -0.5);
    }

    /// <summary>Plus u v^T + v u^T, of a response.</summary>
    public void AddBoth(in Twist u, in Twist v)
    {
        AddOuter(u.Angular, u.Linear, v.Angular, v.Linear);
        AddOuter(v.Angular, v.Linear, u.Angular, u.Linear);
    }

    /// <summary>The response of an inertia: its inverse, in the other order of blocks. Zero where it has none.</summary>
    public readonly SpatialMatrix Response()
    {
        // Of [A B; B^T C], by the Schur complement S = C - B^T A^-1 B: [A^-1 + W S^-1 W^T, -W S^-1; ., S^-1] with W = A^-1 B.
        if (!Invert(_a0, _a1, _a2, out Vector3d i0, out Vector3d i1, out Vector3d i2))
            return default;
        Vector3d w0 = Product(i0, i1, i2, _b0), w1 = Product(i0, i1, i2, _b1), w2 = Product(i0, i1, i2, _b2);
        Vector3d s0 = _c0 - Transposed(_b0, _b1, _b2, w0), s1 = _c1 - Transposed(_b0, _b1, _b2, w1), s2 = _c2 - Transposed(_b0, _b1, _b2, w2);
        if (!Invert(s0, s1, s2, out Vector3d t0, out Vector3d t1, out Vector3d t2))
            return default;

        // Columns of W S^-1, and of its transpose times W^T.
        Vector3d y0 = Product(w0, w1, w2, t0), y1 = Product(w0, w1, w2, t1), y2 = Product(w0, w1, w2, t2);
        return new SpatialMatrix
        {
            _a0 = t0, _a1 = t1, _a2 = t2,
            _b0 = -new Vector3d(y0.X, y1.X, y2.X),
            _b1 = -new Vector3d(y0.Y, y1.Y, y2.Y),
            _b2 = -new Vector3d(y0.Z, y1.Z, y2.Z),
            _c0 = i0 + y0 * w0.X + y1 * w1.X + y2 * w2.X,
            _c1 = i1 + y0 * w0.Y + y1 * w1.Y + y2 * w2.Y,
            _c2 = i2 + y0 * w0.Z + y1 * w1.Z + y2 * w2.Z,
        };
    }

    /// <summary>Of a response: the largest velocity along X, Y or Z by a unit impulse along the same.</summary>
    public readonly double LargestLinear => System.Math.Max(_c0.X, System.Math.Max(_c1.Y, _c2.Z));

    /// <summary>Inverse of a symmetric positive 3 x 3 matrix by its columns; false where it has none.</summary>
    public static bool Invert(Vector3d c0, Vector3d c1, Vector3d c2, out Vector3d i0, out Vector3d i1, out Vector3d i2)
    {
        Vector3d r0 = Vector3d.Cross(c1, c2);
        double determinant = Vector3d.Dot(c0, r0);
        double inverse = determinant > 0 ? 1 / determinant : 0;
        i0 = r0 * inverse;
        i1 = Vector3d.Cross(c2, c0) * inverse;
        i2 = Vector3d.Cross(c0, c1) * inverse;
        return inverse > 0;
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private void AddOuter(in Vector3d first, in Vector3d second, in Vector3d firstT, in Vector3d secondT)
    {
        _a0 += first * firstT.X;
        _a1 += first * firstT.Y;
        _a2 += first * firstT.Z;
        _b0 += first * secondT.X;
        _b1 += first * secondT.Y;
        _b2 += first * secondT.Z;
        _c0 += second * secondT.X;
        _c1 += second * secondT.Y;
        _c2 += second * secondT.Z;
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static Vector3d Product(Vector3d c0, Vector3d c1, Vector3d c2, Vector3d v) => c0 * v.X + c1 * v.Y + c2 * v.Z;

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static Vector3d Transposed(Vector3d c0, Vector3d c1, Vector3d c2, Vector3d v) => new(Vector3d.Dot(c0, v), Vector3d.Dot(c1, v), Vector3d.Dot(c2, v));
}
