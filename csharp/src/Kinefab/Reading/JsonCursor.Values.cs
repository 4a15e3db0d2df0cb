using System;
using System.Buffers;
using System.Collections.Generic;
using System.Text;
using Kinefab.Diagnostics;
using Kinefab.Json;
using Kinefab.Numerics;

namespace Kinefab.Reading;

/// <summary>Values: each method reads one, or reports why not and gives a stand-in.</summary>
internal ref partial struct JsonCursor
{
    /// <summary>A finite number that a 32-bit float holds, as Unity's are.</summary>
    internal double Number()
    {
        if (reader.Token != JsonToken.Number)
        {
            Mismatch("a number");
            return 0;
        }

        double value = reader.GetDouble();
        if (!double.IsInfinity(value))
        {
            if (float.IsInfinity((float)value))
                Report(DiagnosticCodes.NumberBeyondFloat32, ("number", TokenText()));
            return value;
        }

        Report(DiagnosticCodes.NumberNotFinite, ("number", TokenText()));
        return 0;
    }

    /// <summary>An integer that fits 64 bits; 3.0 counts as one, as in JSON Schema.</summary>
    internal long Integer()
    {
        if (reader.Token == JsonToken.Number)
        {
            if (reader.TryGetInt64(out long value))
                return value;
            const double exact = 9007199254740992;
            double number = reader.GetDouble();
            if (Math.Floor(number) == number && Math.Abs(number) <= exact)
                return (long)number;
        }

        Mismatch("an integer");
        return 0;
    }

    /// <summary>An integer that fits 32 bits: a count or a setting.</summary>
    internal int Int()
    {
        long value = Integer();
        if (value is >= int.MinValue and <= int.MaxValue)
            return (int)value;
        Report(DiagnosticCodes.NumberOutOfRange, ("value", TokenText()), ("range", "below 2147483648"));
        return 0;
    }

    /// <summary>True or false.</summary>
    internal bool Boolean()
    {
        if (reader.Token is JsonToken.True or JsonToken.False)
            return reader.Token == JsonToken.True;
        Mismatch("true or false");
        return false;
    }

    /// <summary>A string.</summary>
    internal string Text()
    {
        if (reader.Token != JsonToken.String)
        {
            Mismatch("a string");
            return "";
        }

        return TextOf(reader);
    }

    /// <summary>A string that many objects have alike.</summary>
    internal string SharedText()
    {
        if (reader.Token != JsonToken.String)
            return Text();
        if (!shared.TryGetString(text, reader, out string value))
            Report(DiagnosticCodes.JsonStringInvalid);
        return value;
    }

    private readonly string TextOf(in Utf8Tokenizer at)
    {
        if (!at.TryGetString(out string value))
            Report(DiagnosticCodes.JsonStringInvalid);
        return value;
    }

    /// <summary>One of a set of words.</summary>
    internal T Word<T>(Words<T> words)
        where T : struct
    {
        if (reader.Token != JsonToken.String)
        {
            Mismatch("a string");
            return default;
        }

        if (words.TryFind(reader.IsEscaped ? Encoding.UTF8.GetBytes(TokenText()) : reader.Value, out T value))
            return value;
        Report(DiagnosticCodes.ValueNotAllowed, ("value", TokenText()), ("allowed", words.Listing));
        return default;
    }

    /// <summary>An array of words, each at most once.</summary>
    internal List<T> WordSet<T>(Words<T> words)
        where T : struct
    {
        var set = new List<T>();
        if (reader.Token != JsonToken.StartArray)
            Mismatch("an array");
        else
        {
            while (NextItem())
            {
                T word = Word(words);
                if (set.Contains(word))
                    Report(DiagnosticCodes.ItemDuplicate, ("value", TokenText()));
                set.Add(word);
            }
        }

        return set;
    }

    /// <summary>Three numbers.</summary>
    internal Vector3d Vector3()
    {
        Span<double> v = stackalloc double[3];
        Numbers(v);
        return new Vector3d(v[0], v[1], v[2]);
    }

    /// <summary>Two numbers.</summary>
    internal Vector2d Vector2()
    {
        Span<double> v = stackalloc double[2];
        Numbers(v);
        return new Vector2d(v[0], v[1]);
    }

    /// <summary>Four numbers x y z w.</summary>
    internal Quaterniond Quaternion()
    {
        Span<double> v = stackalloc double[4];
        Numbers(v);
        return new Quaterniond(v[0], v[1], v[2], v[3]);
    }

    /// <summary>An array of exactly as many numbers as there is room for.</summary>
    internal void Numbers(scoped Span<double> values)
    {
        if (reader.Token != JsonToken.StartArray)
        {
            Mismatch($"an array of {Invariant.Text(values.Length)} numbers");
            return;
        }

        long start = Offset;
        int count = 0;
        while (reader.Read() && reader.Token != JsonToken.EndArray)
        {
            double value = Number();
            if (count < values.Length)
                values[count] = value;
            count++;
        }

        if (count != values.Length)
        {
            findings.AddAt(
                start,
                DiagnosticCodes.ArrayLength,
                ("expected", Invariant.Text(values.Length)),
                ("found", Invariant.Text(count)));
        }
    }

    /// <summary>An array of any length.</summary>
    internal T[] List<T>(ReadItem<T> item, int least = 0)
    {
        if (reader.Token != JsonToken.StartArray)
        {
            Mismatch("an array");
            return Array.Empty<T>();
        }

        long start = Offset;
        T[] items;
        if (!NextItem())
            items = Array.Empty<T>();
        else
            items = Items(item(ref this), item);
        if (items.Length < least)
            findings.AddAt(start, DiagnosticCodes.ArrayLength, ("expected", "at least " + Invariant.Text(least)), ("found", Invariant.Text(items.Length)));
        return items;
    }

    private bool NextItem() => reader.Read() && reader.Token != JsonToken.EndArray;

    /// <summary>Most lists have one item; only longer ones need room to grow.</summary>
    private T[] Items<T>(T first, ReadItem<T> item)
    {
        if (!NextItem())
            return One(first);
        T[] pooled = ArrayPool<T>.Shared.Rent(8);
        pooled[0] = first;
        int count = 1;
        do
        {
            if (count == maxItems)
            {
                Report(DiagnosticCodes.ItemsTooMany, ("limit", Invariant.Text(maxItems)));
                throw new ReadingEndedException();
            }

            if (count == pooled.Length)
                pooled = Grow(pooled);
            if (count % ReadingProgress.ItemsBetweenLooks == 0)
                progress.Look(Offset, text.Length);
            pooled[count++] = item(ref this);
        }
        while (NextItem());
        T[] items = pooled.AsSpan(0, count).ToArray();
        Return(pooled, count);
        return items;
    }

    private readonly T[] One<T>(T item) =>
        typeof(T) == typeof(int) ? (T[])(object)shared.Single((int)(object)item!) : new[] { item };

    /// <summary>An object of strings.</summary>
    internal IReadOnlyDictionary<string, string> Dictionary()
    {
        var entries = new Dictionary<string, string>(StringComparer.Ordinal);
        if (reader.Token != JsonToken.StartObject)
        {
            Mismatch("an object");
            return entries;
        }

        while (reader.Read() && reader.Token == JsonToken.PropertyName)
        {
            string name = TextOf(reader);
            if (entries.ContainsKey(name))
                Report(DiagnosticCodes.FieldDuplicate, ("field", name));
            reader.Read();
            entries[name] = Text();
        }

        return entries;
    }

    /// <summary>An object as raw JSON.</summary>
    internal string? Extras()
    {
        if (reader.Token != JsonToken.StartObject)
        {
            Mismatch("an object");
            return null;
        }

        int start = reader.TokenStart;
        PassOver();
        return Encoding.UTF8.GetString(text.Slice(start, reader.Consumed - start));
    }

    /// <summary>
    /// Steps over the current value, of a name over that of its field, which nobody here reads: what no program could write again, a number that no 64-bit
    /// float holds or half of a surrogate pair, which only an escape can be, is reported there too (RFC 7493 has neither).
    /// </summary>
    private void PassOver()
    {
        int depth = 0;
        do
        {
            if (reader.Token == JsonToken.Number && double.IsInfinity(reader.GetDouble()))
                Report(DiagnosticCodes.NumberNotFinite, ("number", TokenText()));
            else if (reader.Token is JsonToken.String or JsonToken.PropertyName && reader.IsEscaped && !reader.TryGetString(out _))
                Report(DiagnosticCodes.JsonStringInvalid);
            depth += reader.Token is JsonToken.StartObject or JsonToken.StartArray ? 1 : reader.Token is JsonToken.EndObject or JsonToken.EndArray ? -1 : 0;
        }
        while ((depth > 0 || reader.Token == JsonToken.PropertyName) && reader.Read());
    }

    private static T[] Grow<T>(T[] full)
    {
        T[] larger = ArrayPool<T>.Shared.Rent(full.Length * 2);
        full.CopyTo(larger, 0);
        Return(full, full.Length);
        return larger;
    }

    private static void Return<T>(T[] pooled, int used)
    {
        Array.Clear(pooled, 0, used);
        ArrayPool<T>.Shared.Return(pooled);
    }
}
