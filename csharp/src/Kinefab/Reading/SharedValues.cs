using System;
using Kinefab.Json;

namespace Kinefab.Reading;

/// <summary>
/// Values that many objects of a file have alike, such as names and lists of one material: equal ones become one object, so that a large scene takes
/// less memory. It remembers the last value of each place of a small table, not all.
/// </summary>
internal sealed class SharedValues
{
    private const int Places = 256;

    private readonly Seen[] texts = new Seen[Places];
    private readonly int[]?[] single = new int[]?[Places];

    /// <summary>The string of the current token; false where half of a surrogate pair is escaped alone.</summary>
    internal bool TryGetString(ReadOnlySpan<byte> text, in Utf8Tokenizer at, out string value)
    {
        ReadOnlySpan<byte> bytes = at.Value;
        if (at.IsEscaped || bytes.IsEmpty)
            return at.TryGetString(out value);
        ref Seen seen = ref texts[FieldNames.Hash(bytes) & (Places - 1)];
        if (seen.Value is string known && text.Slice(seen.Start, seen.Length).SequenceEqual(bytes))
        {
            value = known;
            return true;
        }

        bool isWhole = at.TryGetString(out value);
        if (isWhole)
            seen = new Seen(at.TokenStart + 1, bytes.Length, value);
        return isWhole;
    }

    /// <summary>A list of one number.</summary>
    internal int[] Single(int value) =>
        (uint)value < Places ? single[value] ??= new[] { value } : new[] { value };

    private readonly struct Seen
    {
        internal readonly int Start;
        internal readonly int Length;
        internal readonly string? Value;

        internal Seen(int start, int length, string value)
        {
            Start = start;
            Length = length;
            Value = value;
        }
    }
}
