using System;
using System.Text;
using System.Text.Json;
using Kinefab.Diagnostics;

namespace Kinefab.Json;

/// <summary>Objects whose <c>type</c> field says what they are.</summary>
internal ref partial struct JsonCursor
{
    /// <summary>
    /// Finds out what an object is; the reading of it then starts with <see cref="BeginObject"/> as always.
    /// An object of no or unknown type is reported and stepped over.
    /// </summary>
    internal bool TryBeginTyped<T>(Words<T> types, out T? type)
    {
        type = default;
        if (reader.TokenType != JsonTokenType.StartObject)
        {
            Mismatch("an object");
            return false;
        }

        // Writers put the type first; looking ahead by a copy of the reader costs twice as much.
        Utf8JsonReader start = reader;
        if (reader.Read() && IsType(reader) && reader.Read() && Find(types, reader, out type))
        {
            typedStart = start.TokenStartIndex;
            return true;
        }

        reader = start;
        if (!SeekType(ref start))
            Report(DiagnosticCodes.FieldMissing, ("field", "type"));
        else if (Find(types, start, out type))
            return true;
        else
            ReportUnknown(start);
        reader.Skip();
        return false;
    }

    private static bool IsType(in Utf8JsonReader at) =>
        at.TokenType == JsonTokenType.PropertyName && (at.ValueIsEscaped ? Text(at) == "type" : at.ValueSpan.SequenceEqual("type"u8));

    private static bool Find<T>(Words<T> types, in Utf8JsonReader at, out T? type)
    {
        type = default;
        return at.TokenType == JsonTokenType.String
            && types.TryFind(at.ValueIsEscaped ? Encoding.UTF8.GetBytes(Text(at)) : at.ValueSpan, out type);
    }

    private static bool SeekType(ref Utf8JsonReader ahead)
    {
        while (ahead.Read() && ahead.TokenType == JsonTokenType.PropertyName)
        {
            if (IsType(ahead))
                return ahead.Read();
            ahead.Skip();
        }

        return false;
    }

    private readonly void ReportUnknown(in Utf8JsonReader type)
    {
        if (type.TokenType == JsonTokenType.String)
            findings.AddAt(type.TokenStartIndex, DiagnosticCodes.ComponentTypeUnknown, ("type", Text(type)));
        else
            findings.AddAt(type.TokenStartIndex, DiagnosticCodes.TypeMismatch, ("expected", "a string"), ("found", Kind(type)));
    }
}
