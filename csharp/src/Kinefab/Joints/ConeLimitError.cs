using System;
using Kinefab.Numerics;

namespace Kinefab.Joints;

/// <summary>
/// Distance of a swing from an elliptic cone. The cone is the ellipse (y/Y)^2 + (z/Z)^2 = 1 in the plane of the swing
/// angles y, z; the error is the sine of the angle between the X axis and the nearest line of the cone; where it is exact, the angle.
/// Source: CmConeLimitHelper.h, ConeLimitHelperTanLess and computeAxisAndError.
/// </summary>
internal static class ConeLimitError
{
    // Where the search for the nearest point stops.
    private const double Coarse = 1e-4;
    private const double Exact = 1e-15;

    /// <summary>False when the swing is inside the cone shrunk by the padding.</summary>
    /// <param name="limit">Half angles, radians.</param>
    /// <param name="padding">Radians.</param>
    /// <param name="swing">Rotation without twist.</param>
    /// <param name="isExact">Whether the nearest point is found to rounding and the axis is the error's gradient; PhysX finds it coarsely, so that it jumps,
    /// and its axis near by.</param>
    /// <param name="axis">Unit axis in frame 0 about which a positive rotation leads outwards.</param>
    /// <param name="error">Positive inside.</param>
    public static bool Find(in ConeLimit limit, double padding, Quaterniond swing, bool isExact, out Vector3d axis, out double error)
    {
        axis = Vector3d.Zero;
        error = 0;
        double y = SwingTwist.SwingAngle(swing.Y, swing.W);
        double z = SwingTwist.SwingAngle(swing.Z, swing.W);
        double yPadded = (Math.Abs(y) + padding) / limit.Y;
        double zPadded = (Math.Abs(z) + padding) / limit.Z;
        if (yPadded * yPadded + zPadded * zPadded <= 1)
        {
            return false;
        }

        Vector3d twistAxis = swing * Vector3d.UnitX;
        if (isExact)
        {
            error = ExactError(limit, y, z, twistAxis, out axis);
            return true;
        }

        NearestOnEllipse(y, z, limit.Y, limit.Z, Coarse, out double py, out double pz);
        var radius = new Vector3d(0, Trigonometry.Tan(py / 4), Trigonometry.Tan(pz / 4));
        Vector3d line = Line(radius, new Vector3d(0, py / (limit.Y * limit.Y), pz / (limit.Z * limit.Z)), out Vector3d normal);
        axis = Vector3d.Cross(line, normal) * (1 / normal.Length);
        error = Vector3d.Dot(Vector3d.Cross(line, axis), twistAxis);
        return true;
    }

    // The angle to the cone, and the way along the cone there, about which the X axis turns when that angle alone changes. PhysX's axis, square to
    // the ellipse's normal as it is among the swing angles, is off by some 12 degrees near the tip of a narrow cone, and more beyond it: what
    // holds by it gives energy.
    private static double ExactError(in ConeLimit limit, double y, double z, Vector3d twistAxis, out Vector3d axis)
    {
        Vector3d line, along;
        if (limit.Response.IsSoft && twistAxis.X < 0)
        {
            FindAllRound(limit, twistAxis, out line, out along);
        }
        else
        {
            FindNear(limit, y, z, twistAxis, out line, out along);
        }

        axis = along * (1 / along.Length);
        return Trigonometry.Atan2(Vector3d.Dot(Vector3d.Cross(line, axis), twistAxis), Vector3d.Dot(line, twistAxis));
    }

    // The search begins at the point of the ellipse that is nearest among the swing angles. Of a hard cone it ends there, as on the cone that is the nearest.
    private static void FindNear(in ConeLimit limit, double y, double z, Vector3d twistAxis, out Vector3d line, out Vector3d along)
    {
        const int most = 20;
        const double enough = 1e-14;
        const double widest = 0.3;
        NearestOnEllipse(y, z, limit.Y, limit.Z, Exact, out double py, out double pz);
        double at = Trigonometry.Atan2(pz / limit.Z, py / limit.Y);
        double before = at - 1e-3 * Math.Min(limit.Y, limit.Z) / Math.Max(limit.Y, limit.Z);
        double last = limit.Response.IsSoft ? Along(limit, before, twistAxis, out _, out _) : 0;
        double slope = Along(limit, at, twistAxis, out line, out along);
        Vector3d firstLine = line;
        Vector3d first = along;
        for (int i = 0; i < most && limit.Response.IsSoft && Math.Abs(slope) > enough * along.Length && slope != last; i++)
        {
            double step = Math.Max(-widest, Math.Min(widest, slope * (at - before) / (slope - last)));
            (before, at, last) = (at, at - step, slope);
            slope = Along(limit, at, twistAxis, out line, out along);
        }

        if (Vector3d.Dot(line, twistAxis) < Vector3d.Dot(firstLine, twistAxis))
        {
            // Far beyond the cone the search may end at the point that is farthest.
            line = firstLine;
            along = first;
        }
    }

    // At a swing of more than a right angle that search may end at any line that stands square: the nearest of some all round, and from there by halves.
    private static void FindAllRound(in ConeLimit limit, Vector3d direction, out Vector3d line, out Vector3d along)
    {
        const int all = 32, halvings = 50;
        const double apart = 2 * Math.PI / all;
        double best = 0, most = double.NegativeInfinity;
        for (int i = 0; i < all; i++)
        {
            Along(limit, i * apart, direction, out line, out _);
            double near = Vector3d.Dot(line, direction);
            (best, most) = near > most ? (i * apart, near) : (best, most);
        }

        double low = best - apart, high = best + apart;
        for (int i = 0; i < halvings; i++)
        {
            double middle = (low + high) / 2;
            (low, high) = Along(limit, middle, direction, out _, out _) > 0 ? (middle, high) : (low, middle);
        }

        Along(limit, (low + high) / 2, direction, out line, out along);
    }

    // At the ellipse's point of a parameter: the cone's line, how it moves along it, outwards to the left, and how fast that leads towards a direction.
    private static double Along(in ConeLimit limit, double parameter, Vector3d direction, out Vector3d line, out Vector3d along)
    {
        double cosine = Trigonometry.Cos(parameter);
        double sine = Trigonometry.Sin(parameter);
        var r = new Vector3d(0, Trigonometry.Tan(limit.Y * cosine / 4), Trigonometry.Tan(limit.Z * sine / 4));
        line = Line(r, new Vector3d(0, -limit.Y * sine * (1 + r.Y * r.Y) / 4, limit.Z * cosine * (1 + r.Z * r.Z) / 4), out along);
        return Vector3d.Dot(along, direction);
    }

    // The line of the cone at tangents of quarter angles r, and how it moves with r along d.
    private static Vector3d Line(Vector3d r, Vector3d d, out Vector3d moved)
    {
        double r2 = r.LengthSquared;
        double a = 1 - r2;
        double b = 1 / (1 + r2);
        double b2 = b * b;
        double v1 = 2 * a * b2;
        var v2 = new Vector3d(a, 2 * r.Z, -2 * r.Y);
        Vector3d line = v1 * v2 - Vector3d.UnitX;

        double rd = Vector3d.Dot(r, d);
        double dv1 = -4 * rd * (3 - r2) * b2 * b;
        var dv2 = new Vector3d(-2 * rd, 2 * d.Z, -2 * d.Y);
        moved = v1 * dv2 + dv1 * v2;
        return line;
    }

    // Newton on the Lagrange multiplier; PhysX's start and its coarse stop are kept (PsMathUtils.h, ellipseClamp), since
    // the point it stops at is the one its joint uses.
    private static void NearestOnEllipse(double y, double z, double radiusY, double radiusZ, double converged, out double py, out double pz)
    {
        int maxIterations = converged == Coarse ? 20 : 60;
        const double tiny = 1e-6;
        if (radiusY >= radiusZ ? Math.Abs(z) < tiny : Math.Abs(y) < tiny)
        {
            py = radiusY < radiusZ ? 0 : y > 0 ? radiusY : -radiusY;
            pz = radiusY >= radiusZ ? 0 : z > 0 ? radiusZ : -radiusZ;
            return;
        }

        double ey2 = radiusY * radiusY;
        double ez2 = radiusZ * radiusZ;
        double eqY = radiusY * Math.Abs(y);
        double eqZ = radiusZ * Math.Abs(z);
        double t = Math.Max(eqY - ey2, eqZ - ez2);
        double denominatorY = 0;
        double denominatorZ = 0;
        for (int i = 0; i < maxIterations; i++)
        {
            denominatorY = 1 / (t + ey2);
            denominatorZ = 1 / (t + ez2);
            double fy = eqY * denominatorY;
            double fz = eqZ * denominatorZ;
            fy *= fy;
            fz *= fz;
            double f = fy + fz - 1;
            if (f < converged)
            {
                py = ey2 * y * denominatorY;
                pz = ez2 * z * denominatorZ;
                return;
            }

            t += f / (2 * (fy * denominatorY + fz * denominatorZ));
        }

        py = ey2 * y * denominatorY;
        pz = ez2 * z * denominatorZ;
        double scale = 1 / Math.Sqrt(py / radiusY * (py / radiusY) + pz / radiusZ * (pz / radiusZ));
        py *= scale;
        pz *= scale;
    }
}
