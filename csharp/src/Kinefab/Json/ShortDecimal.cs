using System;

namespace Kinefab.Json;

/// <summary>
/// Decimal numbers of few digits, read exactly and fast.  When the digits fit 53 bits and the power of ten is at most
/// 22, both are exact as doubles, so one multiplication or division rounds once and correctly (W. D. Clinger, "How to
/// read floating point numbers accurately", PLDI 1990).  All others are left to the runtime.
/// </summary>
internal static class ShortDecimal
{
    private const ulong LargestExact = 1UL << 53;

    private static readonly double[] PowersOfTen =
    {
        1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11,
        1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
    };

    /// <summary>From a JSON number without exponent; false when it is not of this kind.</summary>
    internal static bool TryParse(ReadOnlySpan<byte> number, out double value)
    {
        value = 0;
        bool negative = number[0] == '-';
        ulong digits = 0;
        int point = -1;
        int i = negative ? 1 : 0;
        for (; i < number.Length; i++)
        {
            uint digit = (uint)(number[i] - '0');
            if (digit <= 9)
                digits = digits * 10 + digit;
            else if (number[i] == '.')
                point = i;
            else
                return false;
        }

        int count = number.Length - (negative ? 1 : 0) - (point < 0 ? 0 : 1);
        if (count > 19 || digits > LargestExact)
            return false;
        double magnitude = point < 0 ? digits : digits / PowersOfTen[number.Length - 1 - point];
        value = negative ? -magnitude : magnitude;
        return true;
    }
}
