using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Collisions;

/// <summary>
/// How deep two convex shapes overlap: the shortest way that parts them. It is the way from the origin out of their Minkowski
/// difference, found by the expanding polytope algorithm (van den Bergen 2001): the face nearest to the origin is pushed outwards
/// until it is a face of the whole.
/// </summary>
internal sealed class ConvexDepth
{
    private const int MostSteps = 500;

    // Of the size: what counts as flat, and how near the face is to being found.
    private const double Rounding = 1e-11;

    private readonly List<Face> _faces = new();
    private readonly List<(Vector3d From, Vector3d To)> _rim = new();

    /// <summary>Metres; 0 where the two do not touch, or touch without depth.</summary>
    public double Between(ConvexShape first, ConvexShape second)
    {
        var difference = new MinkowskiDifference(first, second);
        double around = first.Radius + second.Radius;
        double apart = ConvexDistance.Of(difference);
        return apart > 0 ? Math.Max(0, around - apart) : around + Penetration(difference);
    }

    private double Penetration(in MinkowskiDifference difference)
    {
        double rounding = Rounding * difference.Size;
        if (!Begin(difference, rounding))
            return 0;
        double shortest = double.PositiveInfinity;
        for (int step = 0; step < MostSteps; step++)
        {
            Face nearest = Nearest();
            Vector3d next = difference.Farthest(nearest.Normal);
            double whole = Vector3d.Dot(next, nearest.Normal);
            shortest = Math.Min(shortest, whole); // that far along any direction parts the two
            if (whole - nearest.Height <= rounding || !Expand(next, rounding))
                break;
        }

        return Math.Max(0, shortest);
    }

    // A tetrahedron of points of the difference; false: it is flat.
    private bool Begin(in MinkowskiDifference difference, double rounding)
    {
        _faces.Clear();
        (Vector3d a, Vector3d b) = Widest(difference, Vector3d.UnitX, Vector3d.UnitY, Vector3d.UnitZ);
        if ((b - a).Length <= rounding)
            return false;
        Vector3d along = (b - a).Normalized();
        Vector3d across = Vector3d.Perpendicular(along);
        Vector3d c = FarthestFrom(difference, a, across, Vector3d.Cross(along, across));
        Vector3d normal = Vector3d.Cross(b - a, c - a);
        if (normal.Length <= rounding * (b - a).Length)
            return false;
        normal = normal.Normalized();
        Vector3d d = FarthestFrom(difference, a, normal, normal);
        double height = Vector3d.Dot(d - a, normal);
        if (Math.Abs(height) <= rounding)
            return false;
        if (height > 0)
            (b, c) = (c, b); // seen from d the face turns clockwise
        return Add(a, b, c) & Add(a, d, b) & Add(b, d, c) & Add(c, d, a);
    }

    private static (Vector3d From, Vector3d To) Widest(in MinkowskiDifference difference, params ReadOnlySpan<Vector3d> directions)
    {
        (Vector3d From, Vector3d To) best = default;
        double most = -1;
        foreach (Vector3d direction in directions)
        {
            Vector3d low = difference.Farthest(-direction);
            Vector3d high = difference.Farthest(direction);
            double width = Vector3d.Dot(high - low, direction);
            if (width > most)
            {
                most = width;
                best = (low, high);
            }
        }

        return best;
    }

    private static Vector3d FarthestFrom(in MinkowskiDifference difference, Vector3d point, params ReadOnlySpan<Vector3d> directions)
    {
        Vector3d best = point;
        double most = -1;
        foreach (Vector3d direction in directions)
        {
            foreach (Vector3d signed in (ReadOnlySpan<Vector3d>)[direction, -direction])
            {
                Vector3d found = difference.Farthest(signed);
                double far = Vector3d.Dot(found - point, signed);
                if (far > most)
                {
                    most = far;
                    best = found;
                }
            }
        }

        return best;
    }

    private Face Nearest()
    {
        Face best = _faces[0];
        foreach (Face face in _faces)
        {
            if (face.Height < best.Height)
                best = face;
        }

        return best;
    }

    // What the point sees goes, and faces in whose plane it lies, so that no sliver is left; the rim is joined to it. False: rounding.
    private bool Expand(Vector3d point, double rounding)
    {
        _rim.Clear();
        int kept = 0;
        for (int i = 0; i < _faces.Count; i++)
        {
            Face face = _faces[i];
            if (Vector3d.Dot(face.Normal, point) - face.Height < -rounding)
            {
                _faces[kept++] = face;
                continue;
            }

            Cross(face.A, face.B);
            Cross(face.B, face.C);
            Cross(face.C, face.A);
        }

        _faces.RemoveRange(kept, _faces.Count - kept);
        foreach ((Vector3d from, Vector3d to) in _rim)
        {
            if (!Add(from, to, point))
                return false;
        }

        return _rim.Count > 0;
    }

    // An edge between two faces that go is none of the rim.
    private void Cross(Vector3d from, Vector3d to)
    {
        int other = _rim.IndexOf((to, from));
        if (other >= 0)
            _rim.RemoveAt(other);
        else
            _rim.Add((from, to));
    }

    private bool Add(Vector3d a, Vector3d b, Vector3d c)
    {
        Vector3d normal = Vector3d.Cross(b - a, c - a);
        double length = normal.Length;
        if (!(length > 0))
            return false;
        normal *= 1 / length;
        _faces.Add(new Face(a, b, c, normal, Vector3d.Dot(normal, a)));
        return true;
    }

    /// <summary>A triangle of the polytope, its normal outwards, and how far its plane lies along that from the origin.</summary>
    private readonly record struct Face(Vector3d A, Vector3d B, Vector3d C, Vector3d Normal, double Height);
}
