using System;
using Kinefab.Numerics;

namespace Kinefab.Collisions;

/// <summary>All points within a distance of the convex hull of some points: a hull, a box, a ball (one point), a capsule (two), a triangle.</summary>
internal sealed class ConvexShape
{
    private readonly Vector3d[] _points;

    /// <param name="points">At least one, in the world, metres.</param>
    /// <param name="radius">Metres round the hull.</param>
    public ConvexShape(Vector3d[] points, double radius)
    {
        _points = points;
        Radius = radius;
        (Low, High) = Box(points, radius);
    }

    public double Radius { get; }

    /// <summary>Corner of the box that holds it, metres.</summary>
    public Vector3d Low { get; }

    /// <summary>Opposite corner.</summary>
    public Vector3d High { get; }

    /// <summary>Points that a search for the farthest one looks at.</summary>
    public int Count => _points.Length;

    /// <summary>Of the hull's points, without the radius, one that lies farthest along a direction.</summary>
    public Vector3d Farthest(Vector3d direction)
    {
        Vector3d best = _points[0];
        double most = Vector3d.Dot(best, direction);
        for (int i = 1; i < _points.Length; i++)
        {
            double along = Vector3d.Dot(_points[i], direction);
            if (along > most)
            {
                most = along;
                best = _points[i];
            }
        }

        return best;
    }

    private static (Vector3d Low, Vector3d High) Box(ReadOnlySpan<Vector3d> points, double radius)
    {
        Vector3d low = points[0];
        Vector3d high = points[0];
        foreach (Vector3d p in points)
        {
            low = new Vector3d(Math.Min(low.X, p.X), Math.Min(low.Y, p.Y), Math.Min(low.Z, p.Z));
            high = new Vector3d(Math.Max(high.X, p.X), Math.Max(high.Y, p.Y), Math.Max(high.Z, p.Z));
        }

        var around = new Vector3d(radius, radius, radius);
        return (low - around, high + around);
    }
}
