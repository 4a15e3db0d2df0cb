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
        // Where an exponent begins differs from runtime to runtime.
        string text = Digits(value);
        int e = text.IndexOf('E');
        if (e >= 0)
            return text.Substring(e) == "E+15" ? WithoutExponent(text.Substring(0, e), 15) : text.Replace('E', 'e');
        if (Math.Abs(value) >= 1e16)
            return WithExponent(text);
        return text.Contains('.') ? text : text + ".0";
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

    private static string WithoutExponent(string mantissa, int exponent)
    {
        int sign = mantissa[0] == '-' ? 1 : 0;
        string digits = mantissa.Replace(".", "", StringComparison.Ordinal);
        int point = sign + exponent + 1;
        return digits.Length > point ? digits.Insert(point, ".") : digits.PadRight(point, '0') + ".0";
    }

    private static string WithExponent(string whole)
    {
        int sign = whole[0] == '-' ? 1 : 0;
        string digits = whole.TrimEnd('0');
        int exponent = whole.Length - sign - 1;
        return (digits.Length > sign + 1 ? digits.Insert(sign + 1, ".") : digits) + "e+" + Invariant.Text(exponent);
    }
}
