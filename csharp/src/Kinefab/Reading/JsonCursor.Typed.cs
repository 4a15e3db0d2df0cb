using System;
using System.Text;
using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Reading;

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
        if (reader.Token != JsonToken.StartObject)
        {
            Mismatch("an object");
            return false;
        }

        // Writers put the type first; looking ahead by a copy of the reader costs twice as much.
        Utf8Tokenizer start = reader;
        if (reader.Read() && IsType(reader) && reader.Read() && Find(types, reader, out type))
        {
            typedStart = start.TokenStart;
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

    private static bool IsType(in Utf8Tokenizer at) =>
        at.Token == JsonToken.PropertyName && (at.IsEscaped ? Text(at) == "type" : at.Value.SequenceEqual("type"u8));

    private static bool Find<T>(Words<T> types, in Utf8Tokenizer at, out T? type)
    {
        type = default;
        return at.Token == JsonToken.String
            && types.TryFind(at.IsEscaped ? Encoding.UTF8.GetBytes(Text(at)) : at.Value, out type);
    }

    private static bool SeekType(ref Utf8Tokenizer ahead)
    {
        while (ahead.Read() && ahead.Token == JsonToken.PropertyName)
        {
            if (IsType(ahead))
                return ahead.Read();
            ahead.Skip();
        }

        return false;
    }

    private readonly void ReportUnknown(in Utf8Tokenizer type)
    {
        if (type.Token == JsonToken.String)
            findings.AddAt(type.TokenStart, DiagnosticCodes.ComponentTypeUnknown, ("type", Text(type)));
        else
            findings.AddAt(type.TokenStart, DiagnosticCodes.TypeMismatch, ("expected", "a string"), ("found", Kind(type)));
    }
}
