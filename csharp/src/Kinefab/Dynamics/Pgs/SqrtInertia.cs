using System;
using System.Runtime.CompilerServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>I^(-1/2) of a body in the world frame: a symmetric 3 x 3 matrix R diag(sqrt(1/I)) R^T.</summary>
internal struct SqrtInertia
{
    private double _xx, _yy, _zz, _xy, _xz, _yz;

    /// <param name="q">World frame from principal axes.</param>
    /// <param name="root">Square roots of the inverse principal moments.</param>
    public static SqrtInertia At(Quaterniond q, Vector3d root)
    {
        JointFrames.Axes(q, out Vector3d x, out Vector3d y, out Vector3d z);
        Vector3d a = x * root.X;
        Vector3d b = y * root.Y;
        Vector3d c = z * root.Z;
        return new SqrtInertia
        {
            _xx = a.X * x.X + b.X * y.X + c.X * z.X,
            _yy = a.Y * x.Y + b.Y * y.Y + c.Y * z.Y,
            _zz = a.Z * x.Z + b.Z * y.Z + c.Z * z.Z,
            _xy = a.X * x.Y + b.X * y.Y + c.X * z.Y,
            _xz = a.X * x.Z + b.X * y.Z + c.X * z.Z,
            _yz = a.Y * x.Z + b.Y * y.Z + c.Y * z.Z,
        };
    }

    /// <summary>Square root of each component.</summary>
    public static Vector3d Root(Vector3d inverseInertia) =>
        new(Math.Sqrt(inverseInertia.X), Math.Sqrt(inverseInertia.Y), Math.Sqrt(inverseInertia.Z));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public readonly Vector3d Times(Vector3d v) => new(
        _xx * v.X + _xy * v.Y + _xz * v.Z,
        _xy * v.X + _yy * v.Y + _yz * v.Z,
        _xz * v.X + _yz * v.Y + _zz * v.Z);
}
