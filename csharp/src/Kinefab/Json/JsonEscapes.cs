using System;
using System.Text;

namespace Kinefab.Json;

/// <summary>Escapes of JSON strings (RFC 8259, section 7).</summary>
internal static class JsonEscapes
{
    /// <summary>A string without its escapes; false where half of a surrogate pair stands alone.</summary>
    /// <param name="raw">Between the quotes; escapes well formed.</param>
    /// <param name="value">Empty when false.</param>
    public static bool TryUnescape(ReadOnlySpan<byte> raw, out string value)
    {
        var text = new StringBuilder(raw.Length);
        value = "";
        while (!raw.IsEmpty)
        {
            int plain = raw.IndexOf((byte)'\\');
            if (plain != 0)
            {
                plain = plain < 0 ? raw.Length : plain;
                text.Append(Encoding.UTF8.GetString(raw.Slice(0, plain)));
                raw = raw.Slice(plain);
                continue;
            }

            if (raw[1] != 'u')
            {
                text.Append(Plain(raw[1]));
                raw = raw.Slice(2);
                continue;
            }

            char unit = Unit(raw);
            raw = raw.Slice(6);
            if (char.IsSurrogate(unit))
            {
                if (!char.IsHighSurrogate(unit) || raw.Length < 6 || raw[0] != '\\' || raw[1] != 'u' || !char.IsLowSurrogate(Unit(raw)))
                    return false;
                text.Append(unit);
                unit = Unit(raw);
                raw = raw.Slice(6);
            }

            text.Append(unit);
        }

        value = text.ToString();
        return true;
    }

    /// <summary>Value of a hexadecimal digit, or -1.</summary>
    public static int Hexadecimal(byte digit) => digit switch
    {
        >= (byte)'0' and <= (byte)'9' => digit - '0',
        >= (byte)'a' and <= (byte)'f' => digit - 'a' + 10,
        >= (byte)'A' and <= (byte)'F' => digit - 'A' + 10,
        _ => -1,
    };

    /// <summary>A string in quotes with what has to be escaped, and no more.</summary>
    public static void AppendQuoted(StringBuilder text, string value)
    {
        text.Append('"');
        foreach (char c in value)
        {
            switch (c)
            {
                case '"' or '\\':
                    text.Append('\\').Append(c);
                    break;
                case '\b':
                    text.Append("\\b");
                    break;
                case '\f':
                    text.Append("\\f");
                    break;
                case '\n':
                    text.Append("\\n");
                    break;
                case '\r':
                    text.Append("\\r");
                    break;
                case '\t':
                    text.Append("\\t");
                    break;
                case < ' ':
                    text.Append("\\u00").Append(((int)c).ToString("x2", System.Globalization.CultureInfo.InvariantCulture));
                    break;
                default:
                    text.Append(c);
                    break;
            }
        }

        text.Append('"');
    }

    private static char Unit(ReadOnlySpan<byte> escape) =>
        (char)(Hexadecimal(escape[2]) << 12 | Hexadecimal(escape[3]) << 8 | Hexadecimal(escape[4]) << 4 | Hexadecimal(escape[5]));

    private static char Plain(byte escaped) => escaped switch
    {
        (byte)'b' => '\b',
        (byte)'f' => '\f',
        (byte)'n' => '\n',
        (byte)'r' => '\r',
        (byte)'t' => '\t',
        _ => (char)escaped,
    };
}
