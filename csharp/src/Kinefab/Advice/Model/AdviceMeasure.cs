using System.Diagnostics;
using System;
using System.Globalization;

namespace Kinefab.Advice;

/// <summary>What a finding measured, before or after a change: a distance, an angle or both.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public readonly struct AdviceMeasure
{
    private const double Millimetres = 1000;

    // Nobody sees so little, of millimetres or degrees.
    private const double Nothing = 5e-4;

    internal AdviceMeasure(double? distance, double? angle)
    {
        Distance = distance;
        Angle = angle;
    }

    /// <summary>Metres; null where only an angle is measured.</summary>
    public double? Distance { get; }

    /// <summary>Degrees; null where only a distance is measured.</summary>
    public double? Angle { get; }

    /// <summary>"1.2 mm and 3 degrees"; of what nobody can see only where there is nothing else.</summary>
    public override string ToString()
    {
        string? distance = Distance is double d ? Text(d * Millimetres) + " mm" : null;
        string? angle = Angle is double a ? Text(a) + " degrees" : null;
        if (distance is null || angle is null)
            return distance ?? angle ?? "nothing";
        if (angle == "0 degrees")
            return distance;
        return distance == "0 mm" ? angle : $"{distance} and {angle}";
    }

    /// <summary>A few digits; 0 for what nobody can see.</summary>
    internal static string Text(double value) => Math.Abs(value) < Nothing
        ? "0"
        : Math.Round(value, value < 10 ? 3 : 1).ToString("0.###", CultureInfo.InvariantCulture);

    /// <summary>The larger of each part.</summary>
    internal static AdviceMeasure Max(AdviceMeasure a, AdviceMeasure b) => new(Max(a.Distance, b.Distance), Max(a.Angle, b.Angle));

    private static double? Max(double? a, double? b) => a is double x && b is double y ? Math.Max(x, y) : a ?? b;
}
