using System.Diagnostics;
using System;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Linear red, green, blue, alpha, each 0 to 1.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public readonly record struct Color
{
    /// <summary>From components.</summary>
    /// <param name="r">Red, 0 to 1, linear.</param>
    /// <param name="g">Green, 0 to 1, linear.</param>
    /// <param name="b">Blue, 0 to 1, linear.</param>
    /// <param name="a">Opacity, 0 to 1.</param>
    public Color(double r, double g, double b, double a)
    {
        R = r;
        G = g;
        B = b;
        A = a;
    }

    /// <summary>Red, 0 to 1, linear.</summary>
    public double R { get; }

    /// <summary>Green, 0 to 1, linear.</summary>
    public double G { get; }

    /// <summary>Blue, 0 to 1, linear.</summary>
    public double B { get; }

    /// <summary>Opacity, 0 to 1.</summary>
    public double A { get; }

    /// <summary>(1, 1, 1, 1).</summary>
    public static Color White => new(1, 1, 1, 1);

    internal static Color Read(ref JsonCursor json)
    {
        Span<double> v = stackalloc double[4];
        json.Numbers(v);
        return new Color(v[0], v[1], v[2], v[3]);
    }

    /// <summary>(r, g, b, a).</summary>
    public override string ToString() => FormattableString.Invariant($"({R}, {G}, {B}, {A})");
}
