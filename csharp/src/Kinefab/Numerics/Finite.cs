using System;

namespace Kinefab.Numerics;

/// <summary>Whether a number that a program gives is one.</summary>
internal static class Finite
{
    /// <summary>True unless NaN or infinite (netstandard2.0, for Mono, has no double.IsFinite).</summary>
    public static bool Is(double value) => !double.IsNaN(value) && !double.IsInfinity(value);

    /// <summary>The value itself.</summary>
    /// <exception cref="ArgumentOutOfRangeException">It is NaN or infinite.</exception>
    public static double OrThrow(double value, string name) =>
        Is(value) ? value : throw new ArgumentOutOfRangeException(name, "Not a finite number.");
}
