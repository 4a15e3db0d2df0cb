using System;
using System.Numerics;

namespace Kinefab.Json;

/// <summary>
/// Decimal numbers of any length, to the nearest double, ties to even: by whole numbers without end. For runtimes whose own reading errs in the
/// last place, as Mono's does with about one number in a thousand; it is slower, and <see cref="ShortDecimal"/> takes most numbers.
/// </summary>
internal static class LongDecimal
{
    // No digit behind these decides but by being there: a tie between two doubles has fewer.
    private const int MostDigits = 800;

    private const int BitsOfMantissa = 53;
    private const int LeastExponent = -1074;

    // Beyond these powers of the first digit all is infinite, or 0.
    private const int InfinitePower = 310;
    private const int VanishingPower = -330;

    /// <summary>From a JSON number; beyond the largest infinite.</summary>
    internal static double Parse(ReadOnlySpan<byte> number)
    {
        bool isNegative = number[0] == '-';
        var digits = new char[Math.Min(number.Length, MostDigits) + 1];
        int count = 0;
        long power = 0;
        bool hasRest = false;
        bool isFraction = false;
        int i = isNegative ? 1 : 0;
        for (; i < number.Length && number[i] is not ((byte)'e' or (byte)'E'); i++)
        {
            if (number[i] == '.')
            {
                isFraction = true;
                continue;
            }

            if (count > 0 || number[i] != '0')
            {
                if (count < MostDigits)
                {
                    digits[count++] = (char)number[i];
                }
                else
                {
                    hasRest |= number[i] != '0';
                    power++;
                }
            }

            if (isFraction)
                power--;
        }

        if (hasRest)
        {
            digits[count++] = '1';
            power--;
        }

        power += Exponent(number.Slice(Math.Min(i + 1, number.Length)));
        double magnitude = count == 0 || power + count < VanishingPower ? 0
            : power + count > InfinitePower ? double.PositiveInfinity
            : Nearest(BigInteger.Parse(new string(digits, 0, count), System.Globalization.CultureInfo.InvariantCulture), (int)power);
        return isNegative ? -magnitude : magnitude;
    }

    // An exponent so long that it does not fit stands for infinity or 0 all the same.
    private static long Exponent(ReadOnlySpan<byte> text)
    {
        const long enough = 1_000_000_000_000;
        long exponent = 0;
        foreach (byte b in text)
        {
            if (b is >= (byte)'0' and <= (byte)'9')
                exponent = Math.Min(enough, exponent * 10 + (b - '0'));
        }

        return !text.IsEmpty && text[0] == '-' ? -exponent : exponent;
    }

    // The quotient with two bits more than a double has, the last of them set where something is left.
    private static double Nearest(BigInteger digits, int power)
    {
        BigInteger over = power > 0 ? digits * BigInteger.Pow(10, power) : digits;
        BigInteger under = power < 0 ? BigInteger.Pow(10, -power) : BigInteger.One;
        int exponent = Math.Max(LeastExponent - 2, Bits(over) - Bits(under) - BitsOfMantissa - 2);
        if (exponent > 0)
            under <<= exponent;
        else
            over <<= -exponent;
        BigInteger quotient = BigInteger.DivRem(over, under, out BigInteger rest);
        // Up to three bits more than wanted, as the lengths are known to one bit.
        int excess = Math.Max(Bits(quotient) - BitsOfMantissa, LeastExponent - exponent);
        BigInteger kept = quotient >> excess;
        BigInteger cut = quotient - (kept << excess);
        BigInteger half = BigInteger.One << (excess - 1);
        if (cut > half || (cut == half && (!rest.IsZero || !kept.IsEven)))
            kept += BigInteger.One;
        return Scaled((long)kept, exponent + excess);
    }

    private static int Bits(BigInteger value)
    {
        byte[] bytes = value.ToByteArray();
        int top = bytes.Length - 1;
        while (top > 0 && bytes[top] == 0)
            top--;
        int bits = 8 * top;
        for (int b = bytes[top]; b != 0; b >>= 1)
            bits++;
        return bits;
    }

    // Exact: a mantissa of 53 bits or one more by rounding up, and an exponent of the format's.
    private static double Scaled(long mantissa, int exponent)
    {
        if (mantissa == 0)
            return 0;
        while (mantissa >= 1L << BitsOfMantissa)
        {
            mantissa >>= 1;
            exponent++;
        }

        if (exponent > 1023 - (BitsOfMantissa - 1))
            return double.PositiveInfinity;
        const long hidden = 1L << (BitsOfMantissa - 1);
        long bits = mantissa < hidden ? mantissa : ((long)(exponent - LeastExponent + 1) << (BitsOfMantissa - 1)) | (mantissa - hidden);
        return BitConverter.Int64BitsToDouble(bits);
    }
}
