using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Joints;

/// <summary>A joint's two frames in the world and frame 1 in frame 0.</summary>
internal struct JointFrames
{
    /// <summary>Origin of frame 1 in the world.</summary>
    public Vector3d P1;

    /// <summary>Rotations in the world; Q1 may have been negated.</summary>
    public Quaterniond Q0;
    public Quaterniond Q1;

    /// <summary>c = F0^-1 * F1: frame 1 in frame 0.</summary>
    public Pose Relative;

    private Vector3d _x0;
    private Vector3d _y0;
    private Vector3d _z0;

    /// <summary>Two frames of the world; written where they stay, since they are large.</summary>
    /// <param name="f0">Frame 0.</param>
    /// <param name="f1">Frame 1.</param>
    /// <param name="extendedLimits">Else Q1 is taken on Q0's side of the double cover, so that the relative angle lies in (-pi, pi].</param>
    /// <param name="f">The frames.</param>
    [MethodImpl(MethodImplOptions.NoInlining)]
    public static void Of(in Pose f0, in Pose f1, bool extendedLimits, out JointFrames f)
    {
        Quaterniond q0 = f0.Rotation;
        Quaterniond q1 = f1.Rotation;
        if (!extendedLimits && Dot(q0, q1) < 0)
        {
            q1 = Negate(q1);
        }

        f.P1 = f1.Position;
        f.Q0 = q0;
        f.Q1 = q1;
        f.Relative = new Pose(q0.InverseRotate(f1.Position - f0.Position), q0.Conjugate() * q1);
        Axes(q0, out f._x0, out f._y0, out f._z0);
    }

    /// <summary>Axis 0, 1 or 2 of frame 0 in the world.</summary>
    public readonly Vector3d Axis0(int i) => i == 0 ? _x0 : i == 1 ? _y0 : _z0;

    /// <summary>Axes of frame 1 in the world.</summary>
    public readonly void Axes1(out Vector3d x, out Vector3d y, out Vector3d z) => Axes(Q1, out x, out y, out z);

    /// <summary>
    /// Rows that turn w1 - w0 into the rate of the vector part of conj(qa) * qb: 1/2 L(qa*) R(qb).
    /// Source: ExtConstraintHelper.h, computeJacobianAxes, with its guard at a relative rotation of 180 degrees.
    /// </summary>
    public static void QuaternionAxes(Quaterniond qa, Quaterniond qb, out Vector3d x, out Vector3d y, out Vector3d z)
    {
        const double floatEpsilon = 1.1920929e-7;
        Vector3d va = qa.Vector;
        Vector3d vb = qb.Vector;
        Vector3d c = vb * qa.W + va * qb.W;
        double d0 = qa.W * qb.W;
        double d1 = Vector3d.Dot(va, vb);
        double d = d0 - d1;
        x = (va * vb.X + vb * va.X + new Vector3d(d, c.Z, -c.Y)) * 0.5;
        y = (va * vb.Y + vb * va.Y + new Vector3d(-c.Z, d, c.X)) * 0.5;
        z = (va * vb.Z + vb * va.Z + new Vector3d(c.Y, -c.X, d)) * 0.5;
        if (d0 + d1 == 0)
        {
            x += new Vector3d(floatEpsilon, 0, 0);
            y += new Vector3d(0, floatEpsilon, 0);
            z += new Vector3d(0, 0, floatEpsilon);
        }
    }

    public static double Dot(Quaterniond a, Quaterniond b) => a.X * b.X + a.Y * b.Y + a.Z * b.Z + a.W * b.W;

    public static Quaterniond Negate(Quaterniond q) => new(-q.X, -q.Y, -q.Z, -q.W);

    /// <summary>The columns of a rotation's matrix.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static void Axes(Quaterniond q, out Vector3d x, out Vector3d y, out Vector3d z)
    {
        double x2 = q.X + q.X, y2 = q.Y + q.Y, z2 = q.Z + q.Z;
        double xx = x2 * q.X, yy = y2 * q.Y, zz = z2 * q.Z;
        double xy = x2 * q.Y, xz = x2 * q.Z, yz = y2 * q.Z;
        double xw = x2 * q.W, yw = y2 * q.W, zw = z2 * q.W;
        x = new Vector3d(1 - yy - zz, xy + zw, xz - yw);
        y = new Vector3d(xy - zw, 1 - xx - zz, yz + xw);
        z = new Vector3d(xz + yw, yz - xw, 1 - xx - yy);
    }
}
