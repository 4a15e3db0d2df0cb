using System.Diagnostics;
using System;
using System.Globalization;
using System.Runtime.CompilerServices;

namespace Kinefab.Numerics;

/// <summary>Three doubles: a point, a direction or a rotation vector; the user says in which frame.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public readonly struct Vector3d : IEquatable<Vector3d>
{
    /// <summary>First component.</summary>
    public double X { get; }

    /// <summary>Second component.</summary>
    public double Y { get; }

    /// <summary>Third component.</summary>
    public double Z { get; }

    /// <summary>From components.</summary>
    /// <param name="x">First component.</param>
    /// <param name="y">Second component.</param>
    /// <param name="z">Third component.</param>
    public Vector3d(double x, double y, double z)
    {
        X = x;
        Y = y;
        Z = z;
    }

    /// <summary>(0, 0, 0).</summary>
    public static Vector3d Zero => default;

    /// <summary>(1, 0, 0).</summary>
    public static Vector3d UnitX => new(1, 0, 0);

    /// <summary>(0, 1, 0).</summary>
    public static Vector3d UnitY => new(0, 1, 0);

    /// <summary>(0, 0, 1).</summary>
    public static Vector3d UnitZ => new(0, 0, 1);

    /// <summary>Component 0, 1 or 2.</summary>
    /// <param name="index">0, 1 or 2.</param>
    public double this[int index] => index switch { 0 => X, 1 => Y, 2 => Z, _ => throw new ArgumentOutOfRangeException(nameof(index)) };

    /// <summary>Squared length.</summary>
    public double LengthSquared => X * X + Y * Y + Z * Z;

    /// <summary>Length.</summary>
    public double Length => Math.Sqrt(LengthSquared);

    /// <summary>True when no component is NaN or infinite.</summary>
    public bool IsFinite => Finite.Is(X) && Finite.Is(Y) && Finite.Is(Z);

    /// <summary>The vector itself.</summary>
    /// <exception cref="ArgumentOutOfRangeException">A component is NaN or infinite.</exception>
    internal Vector3d FiniteOrThrow(string name) => IsFinite ? this : throw new ArgumentOutOfRangeException(name, "Not finite numbers.");

    /// <summary>The same direction with length 1; zero stays zero.</summary>
    /// <returns>Of length 1, or zero.</returns>
    public Vector3d Normalized()
    {
        double length = Length;
        return length > 0 ? this * (1 / length) : Zero;
    }

    /// <summary>Scalar product.</summary>
    /// <param name="a">Left factor.</param>
    /// <param name="b">Right factor, in the same frame.</param>
    /// <returns>The product of the lengths and the cosine between.</returns>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static double Dot(Vector3d a, Vector3d b) => a.X * b.X + a.Y * b.Y + a.Z * b.Z;

    /// <summary>Vector product by the component formula (right-hand rule in a right-handed picture, left-hand in Unity's).</summary>
    /// <param name="a">Left factor.</param>
    /// <param name="b">Right factor, in the same frame.</param>
    /// <returns>At right angles to both; its length is theirs by the sine between.</returns>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Vector3d Cross(Vector3d a, Vector3d b) =>
        new(a.Y * b.Z - a.Z * b.Y, a.Z * b.X - a.X * b.Z, a.X * b.Y - a.Y * b.X);

    /// <summary>Component by component product.</summary>
    /// <param name="a">Left factor.</param>
    /// <param name="b">Right factor.</param>
    /// <returns>(a.x b.x, a.y b.y, a.z b.z).</returns>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Vector3d Scale(Vector3d a, Vector3d b) => new(a.X * b.X, a.Y * b.Y, a.Z * b.Z);

    /// <summary>
    /// A unit vector at right angles to a unit vector: the product of Z with it, or of X within 45 degrees of Z, which is the one
    /// that Unity's Vector3.OrthoNormalize gives.
    /// </summary>
    /// <param name="unit">Of length 1.</param>
    /// <returns>Of length 1.</returns>
    public static Vector3d Perpendicular(Vector3d unit) =>
        Cross(Math.Abs(unit.Z) > Math.Sqrt(0.5) ? UnitX : UnitZ, unit).Normalized();

    /// <summary>Sum.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Vector3d operator +(Vector3d a, Vector3d b) => new(a.X + b.X, a.Y + b.Y, a.Z + b.Z);

    /// <summary>Difference.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Vector3d operator -(Vector3d a, Vector3d b) => new(a.X - b.X, a.Y - b.Y, a.Z - b.Z);

    /// <summary>Opposite.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Vector3d operator -(Vector3d a) => new(-a.X, -a.Y, -a.Z);

    /// <summary>Multiple.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Vector3d operator *(Vector3d a, double s) => new(a.X * s, a.Y * s, a.Z * s);

    /// <summary>Multiple.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Vector3d operator *(double s, Vector3d a) => a * s;

    /// <summary>Exact equality of the components.</summary>
    public static bool operator ==(Vector3d a, Vector3d b) => a.Equals(b);

    /// <summary>Not exactly equal.</summary>
    public static bool operator !=(Vector3d a, Vector3d b) => !a.Equals(b);

    /// <inheritdoc/>
    public bool Equals(Vector3d other) => X.Equals(other.X) && Y.Equals(other.Y) && Z.Equals(other.Z);

    /// <inheritdoc/>
    public override bool Equals(object? obj) => obj is Vector3d other && Equals(other);

    /// <inheritdoc/>
    public override int GetHashCode() => HashCode.Combine(X, Y, Z);

    /// <inheritdoc/>
    public override string ToString() => string.Format(CultureInfo.InvariantCulture, "({0}, {1}, {2})", X, Y, Z);
}
