using System;
using System.Text;

namespace Kinefab.Json;

/// <summary>The fields that a JSON object may have, found by their UTF-8 name without making a string.</summary>
internal sealed class FieldNames
{
    private readonly string[] names;
    private readonly byte[][] utf8;
    private readonly sbyte[] slots;

    /// <summary>At most 64 names, and which of them an object must have: bit i stands for name i.</summary>
    internal FieldNames(ulong required, params string[] names)
    {
        if (names.Length > 64)
            throw new ArgumentException("More than 64 fields do not fit the set of seen ones.", nameof(names));
        this.names = names;
        Required = required;
        utf8 = new byte[names.Length][];
        slots = new sbyte[512];
        Array.Fill(slots, (sbyte)-1);
        for (int i = 0; i < names.Length; i++)
        {
            utf8[i] = Encoding.UTF8.GetBytes(names[i]);
            int slot = Slot(utf8[i]);
            while (slots[slot] >= 0)
                slot = (slot + 1) & (slots.Length - 1);
            slots[slot] = (sbyte)i;
        }
    }

    /// <summary>Bit i stands for name i.</summary>
    internal ulong Required { get; }

    internal string this[int index] => names[index];

    internal int Count => names.Length;

    /// <summary>Index of a name, or -1.</summary>
    internal int IndexOf(ReadOnlySpan<byte> name)
    {
        if (name.IsEmpty)
            return -1;
        for (int slot = Slot(name); ; slot = (slot + 1) & (slots.Length - 1))
        {
            int index = slots[slot];
            if (index < 0 || name.SequenceEqual(utf8[index]))
                return index;
        }
    }

    /// <summary>Of a text that is not empty; cheap, and different for most names of a file.</summary>
    internal static int Hash(ReadOnlySpan<byte> name) => name.Length * 37 + name[0] * 7 + name[^1] * 13 + name[name.Length / 2] * 29;

    private int Slot(ReadOnlySpan<byte> name) => Hash(name) & (slots.Length - 1);
}
