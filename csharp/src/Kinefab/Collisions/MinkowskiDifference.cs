using System;
using Kinefab.Numerics;

namespace Kinefab.Collisions;

/// <summary>All differences between a point of one hull and a point of another: it holds the origin where the two touch.</summary>
internal readonly struct MinkowskiDifference
{
    private readonly ConvexShape _first;
    private readonly ConvexShape _second;

    public MinkowskiDifference(ConvexShape first, ConvexShape second)
    {
        _first = first;
        _second = second;
        Size = Math.Max(Largest(first), Largest(second));
    }

    /// <summary>Metres: of the larger of the two.</summary>
    public double Size { get; }

    /// <summary>Its point that lies farthest along a direction.</summary>
    public Vector3d Farthest(Vector3d direction) => _first.Farthest(direction) - _second.Farthest(-direction);

    private static double Largest(ConvexShape shape)
    {
        Vector3d size = shape.High - shape.Low;
        return Math.Max(size.X, Math.Max(size.Y, size.Z));
    }
}
