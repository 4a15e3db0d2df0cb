using System;
using System.Runtime.CompilerServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>I^(-1/2) of a body in the world frame: a symmetric 3 x 3 matrix R diag(sqrt(1/I)) R^T.</summary>
internal struct SqrtInertia
{
    private Double4 _x, _y, _z;

    /// <param name="q">World frame from principal axes.</param>
    /// <param name="root">Square roots of the inverse principal moments.</param>
    public static SqrtInertia At(Quaterniond q, Vector3d root)
    {
        JointFrames.Axes(q, out Vector3d x, out Vector3d y, out Vector3d z);
        Vector3d a = x * root.X;
        Vector3d b = y * root.Y;
        Vector3d c = z * root.Z;
        double xx = a.X * x.X + b.X * y.X + c.X * z.X;
        double yy = a.Y * x.Y + b.Y * y.Y + c.Y * z.Y;
        double zz = a.Z * x.Z + b.Z * y.Z + c.Z * z.Z;
        double xy = a.X * x.Y + b.X * y.Y + c.X * z.Y;
        double xz = a.X * x.Z + b.X * y.Z + c.X * z.Z;
        double yz = a.Y * x.Z + b.Y * y.Z + c.Y * z.Z;
        return new SqrtInertia
        {
            _x = new Double4(new Vector3d(xx, xy, xz), 0),
            _y = new Double4(new Vector3d(xy, yy, yz), 0),
            _z = new Double4(new Vector3d(xz, yz, zz), 0),
        };
    }

    /// <summary>Square root of each component.</summary>
    public static Vector3d Root(Vector3d inverseInertia) =>
        new(Math.Sqrt(inverseInertia.X), Math.Sqrt(inverseInertia.Y), Math.Sqrt(inverseInertia.Z));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public readonly Double4 Times(Vector3d v) => _x * v.X + _y * v.Y + _z * v.Z;
}
