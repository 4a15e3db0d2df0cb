using System;
using System.Globalization;

namespace Kinefab.Json;

/// <summary>
/// The shortest decimal number that reads back the same, with a point, from 1e16 on and below 1e-4 with an exponent: as
/// Python writes it, so that a scene has one text in both languages.
/// </summary>
internal static class ShortestText
{
    /// <summary>As text.</summary>
    /// <exception cref="ArgumentException">JSON has no such number.</exception>
    internal static string Of(double value)
    {
        if (double.IsNaN(value) || double.IsInfinity(value))
            throw new ArgumentException($"JSON has no number {value.ToString(CultureInfo.InvariantCulture)}.");
        string text = Digits(value);
        int e = text.IndexOf('E');
        if (e < 0)
            return text.Contains('.') ? text : text + ".0";
        int exponent = int.Parse(text.Substring(e + 1), NumberStyles.AllowLeadingSign, CultureInfo.InvariantCulture);
        return exponent == 15 ? Fixed(text.Substring(0, e), exponent) : text.Replace('E', 'e');
    }

    private static string Digits(double value)
    {
#if NETCOREAPP3_0_OR_GREATER
        return value.ToString(CultureInfo.InvariantCulture);
#else
        // "R" of older runtimes is not the shortest.
        for (int digits = 15; digits < 17; digits++)
        {
            string text = value.ToString("G" + Invariant.Text(digits), CultureInfo.InvariantCulture);
            if (double.Parse(text, CultureInfo.InvariantCulture) == value)
                return text;
        }

        return value.ToString("G17", CultureInfo.InvariantCulture);
#endif
    }

    // d.ddd and an exponent, which the runtime has already, without one.
    private static string Fixed(string mantissa, int exponent)
    {
        string sign = mantissa[0] == '-' ? "-" : "";
        string digits = mantissa.Substring(sign.Length).Replace(".", "", StringComparison.Ordinal).PadRight(exponent + 1, '0');
        string fraction = digits.Substring(exponent + 1);
        return sign + digits.Substring(0, exponent + 1) + "." + (fraction.Length == 0 ? "0" : fraction);
    }
}
