using System;
using System.Buffers.Binary;

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

    /// <summary>From a JSON number; false when it is not of this kind.</summary>
    internal static bool TryParse(ReadOnlySpan<byte> number, out double value)
    {
        value = 0;
        int first = number[0] == '-' ? 1 : 0;
        ulong digits = 0;
        int point = -1;
        int i = first;
        for (; i < number.Length; i++)
        {
            uint digit = (uint)(number[i] - '0');
            if (digit <= 9)
            {
                digits = digits * 10 + digit;
                continue;
            }

            if (number[i] != '.')
                break;
            point = i;
            while (i + 8 < number.Length && TryEight(number.Slice(i + 1), ref digits))
                i += 8;
        }

        int count = i - first - (point < 0 ? 0 : 1);
        // More than 19 digits may have overflowed.
        if (count > 19 || digits > LargestExact || !TryExponent(number.Slice(i), out int power))
            return false;
        power -= point < 0 ? 0 : i - 1 - point;
        if (power < -22 || power > 22)
            return false;
        double magnitude = power < 0 ? digits / PowersOfTen[-power] : digits * PowersOfTen[power];
        value = first == 1 ? -magnitude : magnitude;
        return true;
    }

    /// <summary>
    /// Appends the next eight characters when all are digits, four multiplications for the eight (D. Lemire,
    /// "Number parsing at a gigabyte per second", Software: Practice and Experience 51, 2021, section 7).
    /// </summary>
    private static bool TryEight(ReadOnlySpan<byte> text, ref ulong digits)
    {
        ulong eight = BinaryPrimitives.ReadUInt64LittleEndian(text);
        const ulong high = 0xF0F0F0F0F0F0F0F0;
        if (((eight & high) | (((eight + 0x0606060606060606) & high) >> 4)) != 0x3333333333333333)
            return false;
        eight -= 0x3030303030303030;
        eight = eight * 10 + (eight >> 8);
        const ulong mask = 0x000000FF000000FF;
        eight = ((eight & mask) * 0x000F424000000064 + ((eight >> 16) & mask) * 0x0000271000000001) >> 32;
        digits = digits * 100000000 + (uint)eight;
        return true;
    }

    /// <summary>From nothing, or from e, a sign and at most two digits.</summary>
    private static bool TryExponent(ReadOnlySpan<byte> text, out int exponent)
    {
        exponent = 0;
        if (text.IsEmpty)
            return true;
        bool signed = text[1] is (byte)'-' or (byte)'+';
        ReadOnlySpan<byte> digits = text.Slice(signed ? 2 : 1);
        if (digits.Length > 2)
            return false;
        foreach (byte digit in digits)
            exponent = exponent * 10 + (digit - '0');
        if (text[1] == '-')
            exponent = -exponent;
        return true;
    }
}
