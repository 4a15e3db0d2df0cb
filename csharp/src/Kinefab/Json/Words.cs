using System;
using System.Collections.Generic;
using System.Diagnostics.CodeAnalysis;
using System.Linq;
using System.Text;

namespace Kinefab.Json;

/// <summary>The words that JSON uses for the values of an enumeration.</summary>
internal sealed class Words<T>
{
    private readonly (byte[] Utf8, T Value)[] entries;

    internal Words(params (string Word, T Value)[] entries)
    {
        this.entries = entries.Select(entry => (Encoding.UTF8.GetBytes(entry.Word), entry.Value)).ToArray();
        Listing = string.Join(", ", entries.Select(entry => entry.Word));
    }

    /// <summary>All words, for a message.</summary>
    internal string Listing { get; }

    internal bool TryFind(ReadOnlySpan<byte> word, [MaybeNullWhen(false)] out T value)
    {
        foreach ((byte[] utf8, T known) in entries)
        {
            if (word.SequenceEqual(utf8))
            {
                value = known;
                return true;
            }
        }

        value = default;
        return false;
    }

    internal string WordOf(T value)
    {
        foreach ((byte[] utf8, T known) in entries)
        {
            if (EqualityComparer<T>.Default.Equals(known, value))
                return Encoding.UTF8.GetString(utf8);
        }

        throw new ArgumentOutOfRangeException(nameof(value));
    }
}
