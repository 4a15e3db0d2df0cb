using System;
using System.Buffers.Binary;

namespace Kinefab.Json;

/// <summary>
/// Decimal numbers of few digits, read exactly while they are scanned.  When the digits fit 53 bits and the power of ten is at
/// most 22, both are exact as doubles, so one multiplication or division rounds once and correctly (W. D. Clinger, "How to
/// read floating point numbers accurately", PLDI 1990).  All others are left to the runtime.
/// </summary>
internal struct ShortDecimal
{
    private const ulong LargestExact = 1UL << 53;

    // As many fit 64 bits.
    private const int MostDigits = 19;

    private const int MostPower = 22;

    private static readonly double[] PowersOfTen =
    {
        1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11,
        1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
    };

    private ulong _digits;
    private int _count;
    private int _power;
    private bool _isNegative;

    /// <summary>Before the first digit.</summary>
    internal ShortDecimal(bool isNegative)
    {
        this = default;
        _isNegative = isNegative;
    }

    /// <summary>Appends the digits in front of the point.</summary>
    /// <returns>Behind them.</returns>
    internal int AddWhole(ReadOnlySpan<byte> text, int from)
    {
        int end = AddDigits(text, from);
        _count = end - from;
        return end;
    }

    /// <summary>Appends the digits behind the point.</summary>
    /// <returns>Behind them.</returns>
    internal int AddFraction(ReadOnlySpan<byte> text, int from)
    {
        int i = from;
        while (i + 8 <= text.Length && TryAddEight(text.Slice(i)))
            i += 8;
        i = AddDigits(text, i);
        _count += i - from;
        _power = from - i;
        return i;
    }

    /// <summary>Takes the power of ten behind the e.</summary>
    /// <returns>Behind its digits.</returns>
    internal int AddPower(ReadOnlySpan<byte> text, int from, bool isNegative)
    {
        const int beyond = 1000;
        int power = 0;
        int i = from;
        for (; (uint)i < (uint)text.Length && (uint)(text[i] - '0') <= 9; i++)
            power = power < beyond ? power * 10 + (text[i] - '0') : power;
        // The many digits of a fraction do not bring a power that was cut back into range: they are more than MostDigits.
        _power += isNegative ? -power : power;
        return i;
    }

    /// <summary>The number; false when it is not of this kind.</summary>
    internal readonly bool TryGet(out double value)
    {
        value = 0;
        if (_count > MostDigits || _digits > LargestExact || _power < -MostPower || _power > MostPower)
            return false;
        double magnitude = _power < 0 ? _digits / PowersOfTen[-_power] : _digits * PowersOfTen[_power];
        value = _isNegative ? -magnitude : magnitude;
        return true;
    }

    private int AddDigits(ReadOnlySpan<byte> text, int i)
    {
        ulong digits = _digits;
        for (; (uint)i < (uint)text.Length; i++)
        {
            uint digit = (uint)(text[i] - '0');
            if (digit > 9)
                break;
            digits = digits * 10 + digit;
        }

        _digits = digits;
        return i;
    }

    /// <summary>
    /// Appends the next eight characters when all are digits, four multiplications for the eight (D. Lemire,
    /// "Number parsing at a gigabyte per second", Software: Practice and Experience 51, 2021, section 7).
    /// </summary>
    private bool TryAddEight(ReadOnlySpan<byte> text)
    {
        ulong eight = BinaryPrimitives.ReadUInt64LittleEndian(text);
        const ulong high = 0xF0F0F0F0F0F0F0F0;
        if (((eight & high) | (((eight + 0x0606060606060606) & high) >> 4)) != 0x3333333333333333)
            return false;
        eight -= 0x3030303030303030;
        eight = eight * 10 + (eight >> 8);
        const ulong mask = 0x000000FF000000FF;
        eight = ((eight & mask) * 0x000F424000000064 + ((eight >> 16) & mask) * 0x0000271000000001) >> 32;
        _digits = _digits * 100000000 + (uint)eight;
        return true;
    }
}
