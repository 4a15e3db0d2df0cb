using System;
using System.Diagnostics;

namespace Kinefab.Numerics;

/// <summary>Two doubles; the user says of what.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public readonly record struct Vector2d
{
    /// <summary>From components.</summary>
    /// <param name="x">First component, in whatever unit the vector has.</param>
    /// <param name="y">Second component, in the same unit.</param>
    public Vector2d(double x, double y)
    {
        X = x;
        Y = y;
    }

    /// <summary>First component.</summary>
    public double X { get; }

    /// <summary>Second component.</summary>
    public double Y { get; }

    /// <summary>(x, y).</summary>
    public override string ToString() => FormattableString.Invariant($"({X}, {Y})");
}
