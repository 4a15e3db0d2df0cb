using System;
using System.Buffers.Binary;
using System.Buffers.Text;
using System.Runtime.CompilerServices;
using System.Text;

namespace Kinefab.Json;

/// <summary>
/// Reads the tokens of one JSON text forward, strictly by RFC 8259: no comments, no trailing commas, one value. Allocates
/// nothing but for texts deeper than 64. The text is UTF-8 (see <see cref="Utf8Check"/>). A copy reads on by itself.
/// </summary>
internal ref struct Utf8Tokenizer
{
    /// <summary>Containers inside each other of any text that is read: what goes through a value calls itself once for each.</summary>
    public const int MostDepth = 256;

    private readonly ReadOnlySpan<byte> _text;
    private readonly int _maxDepth;

    // Of the containers open, the outermost at bit 0: set for an object. More than 64 continue in the array, which copies
    // share: each writes only above where it was copied, and writes anew what it enters.
    private ulong _isObject;
    private ulong[]? _deeper;
    private int _depth;
    private int _at;
    private int _start;
    private int _valueStart;
    private int _valueLength;
    private bool _isEscaped;
    private JsonToken _token;
    private ShortDecimal _number;

    /// <summary>Before the first token.</summary>
    /// <param name="text">UTF-8 without a byte order mark.</param>
    /// <param name="maxDepth">Containers that may be open at once.</param>
    public Utf8Tokenizer(ReadOnlySpan<byte> text, int maxDepth)
    {
        this = default;
        _text = text;
        _maxDepth = maxDepth;
    }

    public readonly JsonToken Token => _token;

    /// <summary>Offset of the token's first byte, a string's quote included.</summary>
    public readonly int TokenStart => _start;

    /// <summary>Offset behind the token.</summary>
    public readonly int Consumed => _at;

    /// <summary>Bytes of a number, or between a string's quotes as they stand.</summary>
    public readonly ReadOnlySpan<byte> Value => _text.Slice(_valueStart, _valueLength);

    /// <summary>Whether the string holds escapes.</summary>
    public readonly bool IsEscaped => _isEscaped;

    private readonly bool IsInObject => _depth <= 64 ? (_isObject >> (_depth - 1) & 1) != 0 : (_deeper![(_depth - 65) >> 6] >> ((_depth - 65) & 63) & 1) != 0;

    /// <summary>The next token; false behind the last.</summary>
    /// <exception cref="JsonSyntaxException">There is no JSON any more.</exception>
    public bool Read()
    {
        int at = AfterSpace(_at);
        if (_depth == 0)
        {
            if (_token == JsonToken.None)
                return ReadValue(at);
            if (at < _text.Length)
                Fail(at, "The text goes on behind its one value");
            _at = at;
            return false;
        }

        if (at >= _text.Length)
            Fail(at, _token == JsonToken.PropertyName ? "The text ends where a value should be" : IsInObject ? "The text ends inside an object" : "The text ends inside an array");
        byte b = _text[at];
        switch (_token)
        {
            case JsonToken.PropertyName:
                return ReadValue(at);
            case JsonToken.StartObject:
                return b == '}' ? Close(at, JsonToken.EndObject) : ReadName(at);
            case JsonToken.StartArray:
                return b == ']' ? Close(at, JsonToken.EndArray) : ReadValue(at);
        }

        bool isInObject = IsInObject;
        if (b == ',')
        {
            int next = AfterSpace(at + 1);
            if (next >= _text.Length)
                Fail(next == at + 1 ? at : next, "The text ends behind a comma");
            if (_text[next] == (isInObject ? '}' : ']'))
                Fail(next, "A comma stands behind the last item");
            return isInObject ? ReadName(next) : ReadValue(next);
        }

        if (b == (isInObject ? '}' : ']'))
            return Close(at, isInObject ? JsonToken.EndObject : JsonToken.EndArray);
        Fail(at, isInObject ? "A comma or } is missing" : "A comma or ] is missing");
        return false;
    }

    /// <summary>To the end of the current value; of a name to that of its value.</summary>
    public void Skip()
    {
        if (_token == JsonToken.PropertyName)
            Read();
        if (_token is not (JsonToken.StartObject or JsonToken.StartArray))
            return;
        int depth = _depth - 1;
        while (_depth > depth)
            Read();
    }

    /// <summary>The string or name; false where half of a surrogate pair is escaped alone.</summary>
    public readonly bool TryGetString(out string value)
    {
        if (_isEscaped)
            return JsonEscapes.TryUnescape(Value, out value);
        value = Encoding.UTF8.GetString(Value);
        return true;
    }

    /// <summary>The number as an integer, if it is written as one that fits.</summary>
    public readonly bool TryGetInt64(out long value) => Utf8Parser.TryParse(Value, out value, out int used) && used == Value.Length;

    /// <summary>The number, nearest; beyond the largest infinite.</summary>
    public readonly double GetDouble()
    {
        if (_number.TryGet(out double value))
            return value;
#if NET
        return Utf8Parser.TryParse(Value, out value, out _) ? value : LongDecimal.Parse(Value);
#else
        return LongDecimal.Parse(Value);
#endif
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private readonly int AfterSpace(int at)
    {
        ReadOnlySpan<byte> text = _text;
        while ((uint)at < (uint)text.Length && text[at] <= ' ' && IsSpace(text[at]))
            at++;
        return at;
    }

    private static bool IsSpace(byte b) => b is (byte)' ' or (byte)'\n' or (byte)'\r' or (byte)'\t';

    private bool ReadName(int at)
    {
        if (_text[at] != '"')
            Fail(at, "A field's name in quotes is missing");
        ReadString(at);
        int colon = AfterSpace(_at);
        if (colon >= _text.Length || _text[colon] != ':')
            Fail(colon, "A colon is missing behind a field's name");
        _at = colon + 1;
        _token = JsonToken.PropertyName;
        return true;
    }

    private bool ReadValue(int at)
    {
        if (at >= _text.Length)
            Fail(at, "The text ends where a value should be");
        byte b = _text[at];
        if (b == '"')
        {
            ReadString(at);
            _token = JsonToken.String;
            return true;
        }

        if ((uint)(b - '0') <= 9 || b == '-')
            return ReadNumber(at);
        return b switch
        {
            (byte)'{' => Open(at, true),
            (byte)'[' => Open(at, false),
            (byte)'t' => ReadWord(at, "true"u8, JsonToken.True),
            (byte)'f' => ReadWord(at, "false"u8, JsonToken.False),
            (byte)'n' => ReadWord(at, "null"u8, JsonToken.Null),
            _ => Fail(at, "A value is missing or begins wrongly"),
        };
    }

    private bool Open(int at, bool isObject)
    {
        if (_depth >= _maxDepth)
            throw new JsonSyntaxException(at, "The text is nested too deeply", isTooDeep: true);
        _token = isObject ? JsonToken.StartObject : JsonToken.StartArray;
        if (_depth < 64)
        {
            ulong bit = 1UL << _depth;
            _isObject = isObject ? _isObject | bit : _isObject & ~bit;
        }
        else
        {
            int index = _depth - 64;
            _deeper ??= new ulong[(_maxDepth + 63) >> 6];
            ulong bit = 1UL << (index & 63);
            ref ulong word = ref _deeper[index >> 6];
            word = isObject ? word | bit : word & ~bit;
        }

        _depth++;
        _start = at;
        _at = at + 1;
        return true;
    }

    private bool Close(int at, JsonToken token)
    {
        _depth--;
        _token = token;
        _start = at;
        _at = at + 1;
        return true;
    }

    private bool ReadWord(int at, ReadOnlySpan<byte> word, JsonToken token)
    {
        ReadOnlySpan<byte> rest = _text.Slice(at);
        for (int i = 1; i < word.Length; i++)
        {
            if (i >= rest.Length || rest[i] != word[i])
                Fail(at + i, "A value is none of true, false and null");
        }

        _token = token;
        _start = at;
        _valueStart = at;
        _valueLength = word.Length;
        _at = at + word.Length;
        return true;
    }

    private void ReadString(int at)
    {
        ReadOnlySpan<byte> text = _text;
        _start = at;
        _valueStart = at + 1;
        _isEscaped = false;
        int i = at + 1;
        while ((uint)i < (uint)text.Length)
        {
            if (i + 8 <= text.Length)
            {
                int plain = PlainBytes(BinaryPrimitives.ReadUInt64LittleEndian(text.Slice(i)));
                i += plain;
                if (plain == 8)
                    continue;
            }

            byte b = text[i];
            if (b == '"')
            {
                _valueLength = i - at - 1;
                _at = i + 1;
                return;
            }

            if (b < ' ')
                Fail(i, "A control character stands in a string; it is to be escaped");
            if (b != '\\')
            {
                i++;
                continue;
            }

            _isEscaped = true;
            i = AfterEscape(i);
        }

        Fail(text.Length, "The text ends inside a string");
    }

    // How many of eight bytes come before the first that ends a string, begins an escape or is a control character. Where a byte is
    // 0 or below, its high bit is set, and no lower byte's (H. S. Warren, Hacker's Delight, 2nd edition, 2012, section 6-1).
    private static int PlainBytes(ulong eight)
    {
        const ulong ones = 0x0101010101010101, high = 0x8080808080808080;
        ulong quote = eight ^ (ones * '"'), backslash = eight ^ (ones * '\\');
        ulong found = (((quote - ones) & ~quote) | ((backslash - ones) & ~backslash) | ((eight - ones * ' ') & ~eight)) & high;
        return found == 0 ? 8 : (int)(((((found & (0 - found)) - 1) & ones) * ones) >> 56) - 1;
    }

    private readonly int AfterEscape(int backslash)
    {
        ReadOnlySpan<byte> text = _text;
        int i = backslash + 1;
        if (i >= text.Length)
            Fail(text.Length, "The text ends inside a string");
        if (text[i] != 'u')
        {
            if ("\"\\/bfnrt"u8.IndexOf(text[i]) < 0)
                Fail(i, "Nothing is escaped like this in a string");
            return i + 1;
        }

        for (int digit = 1; digit <= 4; digit++)
        {
            if (i + digit >= text.Length)
                Fail(text.Length, "The text ends inside a string");
            if (JsonEscapes.Hexadecimal(text[i + digit]) < 0)
                Fail(i + digit, "Four hexadecimal digits have to follow \\u");
        }

        return i + 5;
    }

    // -? (0 | [1-9] digit*) ('.' digit+)? ([eE] [+-]? digit+)?
    private bool ReadNumber(int at)
    {
        ReadOnlySpan<byte> text = _text;
        int i = at;
        bool isNegative = text[i] == '-';
        if (isNegative)
            NeedDigit(++i, "A digit has to follow the minus sign");
        var number = new ShortDecimal(isNegative);
        i = text[i] == '0' ? i + 1 : number.AddWhole(text, i);
        if (i < text.Length && text[i] == '.')
        {
            NeedDigit(++i, "A digit has to follow the point of a number");
            i = number.AddFraction(text, i);
        }

        if (i < text.Length && (text[i] | 0x20) == 'e')
        {
            i++;
            bool isSmall = i < text.Length && text[i] == '-';
            if (isSmall || (i < text.Length && text[i] == '+'))
                i++;
            NeedDigit(i, "A digit has to follow the e of a number");
            i = number.AddPower(text, i, isSmall);
        }

        // What begins a comment is told as a missing comma, not as part of the number.
        if (i < text.Length && !(text[i] is (byte)',' or (byte)']' or (byte)'}' or (byte)'/' || IsSpace(text[i])))
            Fail(i, "A number is followed by what cannot follow it");
        if (i >= text.Length && _depth > 0)
            Fail(i, "The text ends behind a number");
        _number = number;
        _token = JsonToken.Number;
        _start = at;
        _valueStart = at;
        _valueLength = i - at;
        _at = i;
        return true;
    }

    private readonly void NeedDigit(int i, string message)
    {
        if (i >= _text.Length || (uint)(_text[i] - '0') > 9)
            Fail(i, message);
    }

    private static bool Fail(int offset, string message) => throw new JsonSyntaxException(offset, message);
}
