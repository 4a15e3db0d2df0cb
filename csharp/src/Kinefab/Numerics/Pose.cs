using System.Diagnostics;
using System;

namespace Kinefab.Numerics;

/// <summary>A rigid pose: a point p of the inner frame is <c>Rotation * p + Position</c> in the outer one.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public readonly struct Pose : IEquatable<Pose>
{
    /// <summary>Origin of the inner frame in the outer one, metres.</summary>
    public Vector3d Position { get; }

    /// <summary>Rotation from the inner frame to the outer one, unit quaternion.</summary>
    public Quaterniond Rotation { get; }

    /// <summary>From position and unit rotation.</summary>
    /// <param name="position">Origin of the inner frame in the outer one, metres.</param>
    /// <param name="rotation">From the inner frame to the outer one; of length 1.</param>
    public Pose(Vector3d position, Quaterniond rotation)
    {
        Position = position;
        Rotation = rotation;
    }

    /// <summary>Both frames the same.</summary>
    public static Pose Identity => new(Vector3d.Zero, Quaterniond.Identity);

    /// <summary>The pose of the outer frame in the inner one.</summary>
    /// <returns>The pose that gives the identity when multiplied with this one.</returns>
    public Pose Inverse()
    {
        Quaterniond inverse = Rotation.Conjugate();
        return new Pose(inverse * -Position, inverse);
    }

    /// <summary>The pose in a's outer frame of what stands at b in a's inner frame.</summary>
    public static Pose operator *(Pose a, Pose b) => new(a.Rotation * b.Position + a.Position, a.Rotation * b.Rotation);

    /// <summary>A point of the inner frame in the outer one.</summary>
    /// <param name="p">Metres, in the inner frame.</param>
    /// <returns>Metres, in the outer frame.</returns>
    public Vector3d Point(Vector3d p) => Rotation * p + Position;

    /// <summary>A point of the outer frame in the inner one.</summary>
    /// <param name="p">Metres, in the outer frame.</param>
    /// <returns>Metres, in the inner frame.</returns>
    public Vector3d InversePoint(Vector3d p) => Rotation.InverseRotate(p - Position);

    /// <summary>Exact equality of all components.</summary>
    public static bool operator ==(Pose a, Pose b) => a.Equals(b);

    /// <summary>Not exactly equal.</summary>
    public static bool operator !=(Pose a, Pose b) => !a.Equals(b);

    /// <inheritdoc/>
    public bool Equals(Pose other) => Position == other.Position && Rotation == other.Rotation;

    /// <inheritdoc/>
    public override bool Equals(object? obj) => obj is Pose other && Equals(other);

    /// <inheritdoc/>
    public override int GetHashCode() => unchecked((Position.GetHashCode() * 397) ^ Rotation.GetHashCode());

    /// <summary>(1, 2, 3) m, turned 90 deg about (0, 1, 0).</summary>
    public override string ToString() => $"{Position} m, {Rotation.Turn()}";
}
