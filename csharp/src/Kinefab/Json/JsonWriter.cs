using System;
using System.Buffers.Text;
using System.Text;

namespace Kinefab.Json;

/// <summary>
/// Writes one JSON text as the scene format has it: an object's fields and a list's items in one line, but for those of the
/// root, the items of its lists, and lists that ask for it, which stand on lines of their own.
/// </summary>
internal sealed class JsonWriter
{
    // A half of a surrogate pair has no UTF-8.
    private static readonly UTF8Encoding Strict = new(false, throwOnInvalidBytes: true);

    private readonly StringBuilder _quoted = new();
    private byte[] _bytes = new byte[4096];
    private int _count;

    // Of the containers open, the innermost at bit 0: whether its items stand on lines, and whether it has any.
    private ulong _onLines;
    private ulong _hasItems;
    private int _depth;
    private int _lines;
    private bool _isNamed;

    /// <summary>What has been written so far.</summary>
    internal ReadOnlyMemory<byte> Text => _bytes.AsMemory(0, _count);

    /// <summary>Minor version of the format that what was written needs.</summary>
    internal int Minor { get; private set; }

    internal void Needs(int minor) => Minor = Math.Max(Minor, minor);

    internal void BeginObject() => Begin((byte)'{', _depth == 0);

    internal void EndObject()
    {
        End((byte)'}');
        if (_depth == 0)
            Put((byte)'\n');
    }

    internal void BeginArray(bool lines = false) => Begin((byte)'[', lines || _depth == 1);

    internal void EndArray() => End((byte)']');

    /// <summary>Of the field that comes next; nothing in it is to be escaped.</summary>
    internal void Name(ReadOnlySpan<byte> name)
    {
        Separate();
        Put((byte)'"');
        Put(name);
        Put("\": "u8);
        _isNamed = true;
    }

    /// <inheritdoc cref="Name(ReadOnlySpan{byte})"/>
    internal void Name(string name)
    {
        Separate();
        Quote(name);
        Put(": "u8);
        _isNamed = true;
    }

    internal void Value(string value)
    {
        Separate();
        Quote(value);
    }

    internal void Value(bool value)
    {
        Separate();
        Put(value ? "true"u8 : "false"u8);
    }

    internal void Value(long value)
    {
        Separate();
        Put(value);
    }

    /// <summary>A number in its shortest form that reads back the same, a whole one without a point.</summary>
    /// <exception cref="ArgumentException">JSON has no such number.</exception>
    internal void Value(double value)
    {
        Separate();
        Put(value);
    }

    internal void Numbers(double x, double y)
    {
        BeginArray();
        Value(x);
        Value(y);
        EndArray();
    }

    internal void Numbers(double x, double y, double z)
    {
        BeginArray();
        Value(x);
        Value(y);
        Value(z);
        EndArray();
    }

    internal void Numbers(double x, double y, double z, double w)
    {
        BeginArray();
        Value(x);
        Value(y);
        Value(z);
        Value(w);
        EndArray();
    }

    /// <summary>An object that is there as JSON, in one line.</summary>
    /// <exception cref="ArgumentException">It is none.</exception>
    internal void Object(string json)
    {
        try
        {
            byte[] text = Strict.GetBytes(json);
            var reader = new Utf8Tokenizer(text, Utf8Tokenizer.MostDepth);
            if (!reader.Read() || reader.Token != JsonToken.StartObject)
                throw new ArgumentException($"What should be an object in JSON is none: {json}");
            Copy(ref reader);
            reader.Read();
        }
        catch (JsonSyntaxException fault)
        {
            throw new ArgumentException($"What should be an object in JSON is none: {fault.Message}, at byte {Invariant.Text(fault.Offset)} of {json}", fault);
        }
    }

    private void Copy(ref Utf8Tokenizer reader)
    {
        if (reader.Token is not (JsonToken.StartObject or JsonToken.StartArray))
        {
            if (reader.Token == JsonToken.String)
                Value(TextOf(reader));
            else if (reader.Token == JsonToken.Number && reader.GetDouble() is double number && (double.IsInfinity(number) || reader.Value.IndexOfAny((byte)'.', (byte)'e', (byte)'E') >= 0))
                Value(number);
            else
            {
                Separate();
                Put(reader.Value);
            }

            return;
        }

        // Not through Begin: however deep it is, it stands in one line.
        Separate();
        bool isObject = reader.Token == JsonToken.StartObject;
        Put(isObject ? (byte)'{' : (byte)'[');
        for (bool isFirst = true; reader.Read() && reader.Token is not (JsonToken.EndObject or JsonToken.EndArray); isFirst = false)
        {
            if (!isFirst)
                Put(", "u8);
            if (isObject)
            {
                Quote(TextOf(reader));
                Put(": "u8);
                reader.Read();
            }

            _isNamed = true;
            Copy(ref reader);
        }

        Put(isObject ? (byte)'}' : (byte)']');
    }

    private static string TextOf(in Utf8Tokenizer reader) =>
        reader.TryGetString(out string text) ? text : throw new ArgumentException("Half of a surrogate pair stands alone in a string.");

    private void Begin(byte bracket, bool lines)
    {
        Separate();
        Put(bracket);
        _depth++;
        _onLines = _onLines << 1 | (lines ? 1UL : 0);
        _hasItems <<= 1;
        _lines += lines ? 1 : 0;
    }

    private void End(byte bracket)
    {
        bool lines = (_onLines & 1) != 0;
        _lines -= lines ? 1 : 0;
        if (lines && (_hasItems & 1) != 0)
            NewLine();
        Put(bracket);
        _depth--;
        _onLines >>= 1;
        _hasItems >>= 1;
    }

    /// <summary>What stands before a field or an item.</summary>
    private void Separate()
    {
        if (_isNamed)
        {
            _isNamed = false;
            return;
        }

        if (_depth == 0)
            return;
        bool lines = (_onLines & 1) != 0;
        if ((_hasItems & 1) != 0)
            Put(lines ? ","u8 : ", "u8);
        _hasItems |= 1;
        if (lines)
            NewLine();
    }

    private void NewLine()
    {
        Put((byte)'\n');
        for (int i = 0; i < 2 * _lines; i++)
            Put((byte)' ');
    }

    private void Quote(string value)
    {
        _quoted.Clear();
        JsonEscapes.AppendQuoted(_quoted, value);
        string quoted = _quoted.ToString();
        Reserve(Strict.GetMaxByteCount(quoted.Length));
        _count += Strict.GetBytes(quoted, 0, quoted.Length, _bytes, _count);
    }

    private void Put(double value)
    {
        const double whole = 1e15;
        if (Math.Floor(value) == value && Math.Abs(value) < whole)
            Put((long)value);
        else
            Put(Encoding.ASCII.GetBytes(ShortestText.Of(value)));
    }

    private void Put(long value)
    {
        Reserve(20);
        Utf8Formatter.TryFormat(value, _bytes.AsSpan(_count), out int written);
        _count += written;
    }

    private void Put(byte value)
    {
        Reserve(1);
        _bytes[_count++] = value;
    }

    private void Put(ReadOnlySpan<byte> text)
    {
        Reserve(text.Length);
        text.CopyTo(_bytes.AsSpan(_count));
        _count += text.Length;
    }

    private void Reserve(int more)
    {
        if (_bytes.Length - _count < more)
            Array.Resize(ref _bytes, (int)Math.Min(0x7FFFFFC7, Math.Max(_bytes.Length * 2L, _count + (long)more)));
    }
}
