using System;
using System.Globalization;

namespace Kinefab.Advice;

/// <summary>What a finding measured, before or after a change.</summary>
public readonly struct AdviceMeasure
{
    private const double Millimetres = 1000;
    private const double Nothing = 5e-4;

    internal AdviceMeasure(double distance, double angle)
    {
        Distance = distance;
        Angle = angle;
    }

    /// <summary>Metres.</summary>
    public double Distance { get; }

    /// <summary>Degrees.</summary>
    public double Angle { get; }

    /// <summary>"1.2 mm and 3 degrees"; a part that is exactly none is left out.</summary>
    public override string ToString()
    {
        string distance = Text(Distance * Millimetres) + " mm";
        string angle = Text(Angle) + " degrees";
        return Angle == 0 ? distance : Distance == 0 ? angle : $"{distance} and {angle}";
    }

    /// <summary>A few digits; 0 for what nobody can see.</summary>
    internal static string Text(double value) => Math.Abs(value) < Nothing
        ? "0"
        : Math.Round(value, value < 10 ? 3 : 1).ToString("0.###", CultureInfo.InvariantCulture);

    internal static AdviceMeasure Max(AdviceMeasure a, AdviceMeasure b) => new(Math.Max(a.Distance, b.Distance), Math.Max(a.Angle, b.Angle));
}
