using System.Diagnostics;
using System;
using System.Globalization;
using System.Runtime.CompilerServices;

namespace Kinefab.Numerics;

/// <summary>A rotation as a quaternion (x, y, z, w) of doubles; formulas are Unity's and PhysX's, component by component.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public readonly struct Quaterniond : IEquatable<Quaterniond>
{
    /// <summary>First component of the vector part.</summary>
    public double X { get; }

    /// <summary>Second component of the vector part.</summary>
    public double Y { get; }

    /// <summary>Third component of the vector part.</summary>
    public double Z { get; }

    /// <summary>Scalar part.</summary>
    public double W { get; }

    /// <summary>From components; not normalised.</summary>
    /// <param name="x">First component of the vector part.</param>
    /// <param name="y">Second component of the vector part.</param>
    /// <param name="z">Third component of the vector part.</param>
    /// <param name="w">Scalar part.</param>
    public Quaterniond(double x, double y, double z, double w)
    {
        X = x;
        Y = y;
        Z = z;
        W = w;
    }

    /// <summary>No rotation.</summary>
    public static Quaterniond Identity => new(0, 0, 0, 1);

    /// <summary>The vector part.</summary>
    public Vector3d Vector => new(X, Y, Z);

    /// <summary>Squared length.</summary>
    public double LengthSquared => X * X + Y * Y + Z * Z + W * W;

    /// <summary>The inverse of a unit quaternion.</summary>
    /// <returns>(-x, -y, -z, w).</returns>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Quaterniond Conjugate() => new(-X, -Y, -Z, W);

    /// <summary>The same rotation with length 1; zero becomes the identity.</summary>
    /// <returns>A unit quaternion.</returns>
    public Quaterniond Normalized()
    {
        double length = Math.Sqrt(LengthSquared);
        return length > 0 ? new Quaterniond(X / length, Y / length, Z / length, W / length) : Identity;
    }

    /// <summary>Rotation by <paramref name="angle"/> radians about a unit <paramref name="axis"/>.</summary>
    /// <param name="axis">Of length 1.</param>
    /// <param name="angle">Radians; clockwise as seen along the axis in Unity's left-handed frame, counter-clockwise in a right-handed one.</param>
    /// <returns>A unit quaternion.</returns>
    public static Quaterniond AxisAngle(Vector3d axis, double angle)
    {
        double s = Trigonometry.Sin(angle / 2);
        return new Quaterniond(axis.X * s, axis.Y * s, axis.Z * s, Trigonometry.Cos(angle / 2));
    }

    /// <summary>The rotation whose axes are the given unit vectors (columns of its matrix), w not negative.</summary>
    /// <param name="x">Where the first axis is turned to; of length 1.</param>
    /// <param name="y">Where the second axis is turned to; at right angles to the first.</param>
    /// <param name="z">Where the third axis is turned to: the product of the other two.</param>
    /// <returns>A unit quaternion.</returns>
    public static Quaterniond FromAxes(Vector3d x, Vector3d y, Vector3d z)
    {
        double trace = x.X + y.Y + z.Z;
        Quaterniond q;
        if (trace >= x.X && trace >= y.Y && trace >= z.Z)
        {
            q = new Quaterniond(y.Z - z.Y, z.X - x.Z, x.Y - y.X, 1 + trace);
        }
        else if (x.X >= y.Y && x.X >= z.Z)
        {
            q = new Quaterniond(1 + x.X - y.Y - z.Z, y.X + x.Y, z.X + x.Z, y.Z - z.Y);
        }
        else if (y.Y >= z.Z)
        {
            q = new Quaterniond(y.X + x.Y, 1 + y.Y - x.X - z.Z, z.Y + y.Z, z.X - x.Z);
        }
        else
        {
            q = new Quaterniond(z.X + x.Z, z.Y + y.Z, 1 + z.Z - x.X - y.Y, x.Y - y.X);
        }

        q = q.Normalized();
        return q.W < 0 ? new Quaterniond(-q.X, -q.Y, -q.Z, -q.W) : q;
    }

    /// <summary>First b, then a.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Quaterniond operator *(Quaterniond a, Quaterniond b) => new(
        a.W * b.X + a.X * b.W + a.Y * b.Z - a.Z * b.Y,
        a.W * b.Y - a.X * b.Z + a.Y * b.W + a.Z * b.X,
        a.W * b.Z + a.X * b.Y - a.Y * b.X + a.Z * b.W,
        a.W * b.W - a.X * b.X - a.Y * b.Y - a.Z * b.Z);

    /// <summary>The vector turned by a unit quaternion.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Vector3d operator *(Quaterniond q, Vector3d v)
    {
        Vector3d u = q.Vector;
        Vector3d t = 2 * Vector3d.Cross(u, v);
        return v + q.W * t + Vector3d.Cross(u, t);
    }

    /// <summary>The vector turned by the inverse of a unit quaternion.</summary>
    /// <param name="v">In the outer frame.</param>
    /// <returns>The same vector in the inner frame.</returns>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Vector3d InverseRotate(Vector3d v) => Conjugate() * v;

    /// <summary>In words: turned 90 deg about (0, 1, 0), by no more than half a turn; six digits.</summary>
    internal string Turn()
    {
        double length = Vector.Length;
        if (!(length > 0))
            return length == 0 ? "unturned" : "no rotation";
        double half = Trigonometry.Atan2(length, Math.Abs(W));
        Vector3d axis = Vector * ((W < 0 ? -1 : 1) / length);
        return FormattableString.Invariant($"turned {half * 360 / Math.PI:0.######} deg about ({axis.X:0.######}, {axis.Y:0.######}, {axis.Z:0.######})");
    }

    /// <summary>Exact equality of the components.</summary>
    public static bool operator ==(Quaterniond a, Quaterniond b) => a.Equals(b);

    /// <summary>Not exactly equal.</summary>
    public static bool operator !=(Quaterniond a, Quaterniond b) => !a.Equals(b);

    /// <inheritdoc/>
    public bool Equals(Quaterniond other) => X.Equals(other.X) && Y.Equals(other.Y) && Z.Equals(other.Z) && W.Equals(other.W);

    /// <inheritdoc/>
    public override bool Equals(object? obj) => obj is Quaterniond other && Equals(other);

    /// <inheritdoc/>
    public override int GetHashCode() => HashCode.Combine(X, Y, Z, W);

    /// <inheritdoc/>
    public override string ToString() => string.Format(CultureInfo.InvariantCulture, "({0}, {1}, {2}, {3})", X, Y, Z, W);
}
