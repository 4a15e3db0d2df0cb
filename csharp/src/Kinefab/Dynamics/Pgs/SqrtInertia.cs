using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>I^(-1/2) of a body in the world frame: a symmetric 3 x 3 matrix R diag(sqrt(1/I)) R^T.</summary>
internal struct SqrtInertia
{
    private double _xx, _yy, _zz, _xy, _xz, _yz;

    public static SqrtInertia At(Quaterniond q, Vector3d inverseInertia)
    {
        Vector3d x = q * Vector3d.UnitX;
        Vector3d y = q * Vector3d.UnitY;
        Vector3d z = q * Vector3d.UnitZ;
        double a = Math.Sqrt(inverseInertia.X);
        double b = Math.Sqrt(inverseInertia.Y);
        double c = Math.Sqrt(inverseInertia.Z);
        return new SqrtInertia
        {
            _xx = a * x.X * x.X + b * y.X * y.X + c * z.X * z.X,
            _yy = a * x.Y * x.Y + b * y.Y * y.Y + c * z.Y * z.Y,
            _zz = a * x.Z * x.Z + b * y.Z * y.Z + c * z.Z * z.Z,
            _xy = a * x.X * x.Y + b * y.X * y.Y + c * z.X * z.Y,
            _xz = a * x.X * x.Z + b * y.X * y.Z + c * z.X * z.Z,
            _yz = a * x.Y * x.Z + b * y.Y * y.Z + c * z.Y * z.Z,
        };
    }

    public readonly Vector3d Times(Vector3d v) => new(
        _xx * v.X + _xy * v.Y + _xz * v.Z,
        _xy * v.X + _yy * v.Y + _yz * v.Z,
        _xz * v.X + _yz * v.Y + _zz * v.Z);
}
