using System;
using Kinefab.Numerics;

namespace Kinefab.Collisions;

/// <summary>
/// How far two hulls are apart, by the algorithm of Gilbert, Johnson and Keerthi (1988): the simplex of the Minkowski difference
/// that is nearest to the origin grows by the farthest point towards it.
/// </summary>
internal static class ConvexDistance
{
    private const int MostSteps = 100;

    // Of the squared distance: what another step may still gain.
    private const double Gain = 1e-12;

    // Of the size: nearer than this is touching.
    private const double Touching = 1e-12;

    /// <summary>Metres; 0 where they touch or overlap.</summary>
    public static double Of(in MinkowskiDifference difference)
    {
        double least = Touching * difference.Size;
        Span<Vector3d> simplex = stackalloc Vector3d[4];
        simplex[0] = difference.Farthest(Vector3d.UnitX);
        int count = 1;
        Vector3d nearest = simplex[0];
        for (int step = 0; step < MostSteps; step++)
        {
            double square = nearest.LengthSquared;
            if (square <= least * least)
                return 0;
            Vector3d next = difference.Farthest(-nearest);
            if (square - Vector3d.Dot(nearest, next) <= Gain * square)
                break;
            simplex[count++] = next;
            Vector3d closer = Nearest(simplex, ref count);
            if (!(closer.LengthSquared < square))
                break; // rounding has the last word
            nearest = closer;
        }

        return nearest.Length;
    }

    /// <summary>The simplex's point nearest to the origin; only the corners that carry it are kept.</summary>
    private static Vector3d Nearest(Span<Vector3d> simplex, ref int count) => count switch
    {
        1 => simplex[0],
        2 => OfSegment(simplex, ref count),
        3 => OfTriangle(simplex, ref count),
        _ => OfTetrahedron(simplex, ref count),
    };

    private static Vector3d OfSegment(Span<Vector3d> s, ref int count)
    {
        Vector3d a = s[0];
        Vector3d along = s[1] - a;
        double t = -Vector3d.Dot(a, along);
        double all = along.LengthSquared;
        if (t > 0 && t < all)
            return a + t / all * along;
        s[0] = t <= 0 ? a : s[1];
        count = 1;
        return s[0];
    }

    // Ericson, Real-Time Collision Detection (2005), 5.1.5: by the regions of the corners, the edges and the face.
    private static Vector3d OfTriangle(Span<Vector3d> s, ref int count)
    {
        Vector3d a = s[0];
        Vector3d b = s[1];
        Vector3d c = s[2];
        Vector3d ab = b - a;
        Vector3d ac = c - a;
        double d1 = -Vector3d.Dot(ab, a);
        double d2 = -Vector3d.Dot(ac, a);
        if (d1 <= 0 && d2 <= 0)
            return Keep(s, ref count, a);
        double d3 = -Vector3d.Dot(ab, b);
        double d4 = -Vector3d.Dot(ac, b);
        if (d3 >= 0 && d4 <= d3)
            return Keep(s, ref count, b);
        double d5 = -Vector3d.Dot(ab, c);
        double d6 = -Vector3d.Dot(ac, c);
        if (d6 >= 0 && d5 <= d6)
            return Keep(s, ref count, c);
        double vc = d1 * d4 - d3 * d2;
        if (vc <= 0 && d1 >= 0 && d3 <= 0)
            return KeepEdge(s, ref count, a, b);
        double vb = d5 * d2 - d1 * d6;
        if (vb <= 0 && d2 >= 0 && d6 <= 0)
            return KeepEdge(s, ref count, a, c);
        double va = d3 * d6 - d5 * d4;
        if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
            return KeepEdge(s, ref count, b, c);
        double sum = va + vb + vc;
        return a + vb / sum * ab + vc / sum * ac;
    }

    private static Vector3d OfTetrahedron(Span<Vector3d> s, ref int count)
    {
        ReadOnlySpan<Vector3d> corners = stackalloc Vector3d[] { s[0], s[1], s[2], s[3] };
        Span<Vector3d> best = stackalloc Vector3d[4];
        Span<Vector3d> face = stackalloc Vector3d[4];
        bool isInside = true;
        double least = double.PositiveInfinity;
        Vector3d nearest = default;
        int kept = 0;
        for (int opposite = 0; opposite < 4; opposite++)
        {
            for (int i = 0, k = 0; i < 4; i++)
            {
                if (i != opposite)
                    face[k++] = corners[i];
            }

            Vector3d normal = Vector3d.Cross(face[1] - face[0], face[2] - face[0]);
            double origin = -Vector3d.Dot(normal, face[0]);
            double inner = Vector3d.Dot(normal, corners[opposite] - face[0]);
            if (origin * inner > 0)
                continue; // on the inner side of this face; of a flat tetrahedron of none
            isInside = false;
            int left = 3;
            Vector3d found = OfTriangle(face, ref left);
            if (found.LengthSquared < least)
            {
                least = found.LengthSquared;
                nearest = found;
                kept = left;
                face.CopyTo(best);
            }
        }

        if (isInside)
            return Vector3d.Zero;
        best.CopyTo(s);
        count = kept;
        return nearest;
    }

    private static Vector3d Keep(Span<Vector3d> s, ref int count, Vector3d corner)
    {
        s[0] = corner;
        count = 1;
        return corner;
    }

    private static Vector3d KeepEdge(Span<Vector3d> s, ref int count, Vector3d from, Vector3d to)
    {
        s[0] = from;
        s[1] = to;
        count = 2;
        return OfSegment(s, ref count);
    }
}
