using System;
using System.Text;
using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Reading;

/// <summary>
/// Reads one JSON text forward, strictly, without building a tree.  What does not fit is reported and stepped over,
/// so that one run finds all faults; only broken JSON ends the reading (<see cref="JsonSyntaxException"/>).
/// Every reading method starts on the first token of a value and ends on its last.
/// </summary>
internal ref partial struct JsonCursor
{
    private readonly ReadOnlySpan<byte> text;
    private readonly Findings findings;
    private readonly Severity unknownFields;
    private readonly int maxItems;
    private readonly ReadingProgress progress;
    private readonly SharedValues shared;
    private readonly long textStart;
    private Utf8Tokenizer reader;

    /// <summary>Start of the object whose <c>type</c> was read ahead of its other fields, or -1.</summary>
    private long typedStart;

    /// <summary>On the text's first token.</summary>
    internal JsonCursor(ReadOnlySpan<byte> text, Findings findings, int maxItems, int maxDepth, bool strict, ReadingProgress progress = default)
    {
        this.text = text;
        this.findings = findings;
        unknownFields = strict ? Severity.Error : Severity.Warning;
        this.maxItems = maxItems;
        this.progress = progress;
        shared = new SharedValues();
        reader = new Utf8Tokenizer(text, maxDepth);
        typedStart = -1;
        reader.Read();
        textStart = reader.TokenStart;
    }

    /// <summary>A value of an array, made from the cursor.</summary>
    internal delegate T ReadItem<out T>(ref JsonCursor json);

    /// <summary>Byte offset of the current token.</summary>
    internal readonly long Offset => reader.TokenStart;

    /// <summary>Nothing but white space may follow the value that was read last.</summary>
    internal void End() => reader.Read();

    /// <summary>Steps into an object; <see cref="NextField"/> gives its fields.</summary>
    internal FieldCursor BeginObject(FieldNames names)
    {
        if (typedStart >= 0)
        {
            var typed = new FieldCursor(names, typedStart) { Seen = 1UL << names.IndexOf("type"u8) };
            typedStart = -1;
            return typed;
        }

        if (reader.Token == JsonToken.StartObject)
            return new FieldCursor(names, reader.TokenStart);
        Mismatch("an object");
        return new FieldCursor(null, 0);
    }

    /// <summary>Steps to the value of the next known field; false behind the last one.  Unknown, double and missing fields are reported.</summary>
    internal bool NextField(ref FieldCursor fields)
    {
        if (fields.Names is null)
            return false;
        while (reader.Read() && reader.Token == JsonToken.PropertyName)
        {
            int index = reader.IsEscaped ? IndexOfEscaped(fields.Names) : fields.Names.IndexOf(reader.Value);
            ulong bit = 1UL << index;
            if (index >= 0 && (fields.Seen & bit) == 0)
            {
                fields.Seen |= bit;
                fields.Index = index;
                reader.Read();
                return true;
            }

            if (index < 0)
                findings.AddAt(Offset, unknownFields, DiagnosticCodes.FieldUnknown, ("field", TokenText()));
            else
                findings.AddAt(Offset, DiagnosticCodes.FieldDuplicate, ("field", fields.Names[index]));
            PassOver();
        }

        if ((fields.Seen & fields.Names.Required) != fields.Names.Required)
            ReportMissing(fields);
        return false;
    }

    /// <summary>Reports about the current token.</summary>
    internal readonly void Report(string code, params (string Name, string Value)[] values) => findings.AddAt(Offset, code, values);

    /// <summary>Reports about the current token, drops all other findings and ends the reading.</summary>
    internal readonly void ReportAlone(string code, params (string Name, string Value)[] values) => ReportAlone(Offset, code, values);

    private readonly void ReportAlone(long offset, string code, params (string Name, string Value)[] values)
    {
        findings.Clear();
        findings.AddAt(offset, code, values);
        throw new ReadingEndedException();
    }

    /// <summary>Reports that the current value is of another type, and steps over it.</summary>
    internal void Mismatch(string expected)
    {
        Report(DiagnosticCodes.TypeMismatch, ("expected", expected), ("found", Kind(reader)));
        reader.Skip();
    }

    private readonly void ReportMissing(in FieldCursor fields)
    {
        FieldNames names = fields.Names!;
        if (fields.Start == textStart && (names.Required & fields.Seen) == 0)
            ReportAlone(fields.Start, DiagnosticCodes.FormatMissing); // another format's file: what else is amiss in it means nothing
        for (int i = 0; i < names.Count; i++)
        {
            if ((names.Required & ~fields.Seen & (1UL << i)) != 0)
                findings.AddAt(fields.Start, DiagnosticCodes.FieldMissing, ("field", names[i]));
        }
    }

    private readonly int IndexOfEscaped(FieldNames names) => names.IndexOf(Encoding.UTF8.GetBytes(TokenText()));

    private readonly string TokenText() => Text(reader);

    private static string Kind(in Utf8Tokenizer at) => at.Token switch
    {
        JsonToken.StartObject => "an object",
        JsonToken.StartArray => "an array",
        JsonToken.String => "a string",
        JsonToken.Number => "the number " + Text(at),
        JsonToken.Null => "null",
        _ => "a boolean",
    };

    /// <summary>A token for a message: shortened, whatever is in it.</summary>
    private static string Text(in Utf8Tokenizer at)
    {
        const int enough = 60;
        if (at.Token is not (JsonToken.String or JsonToken.PropertyName) || !at.TryGetString(out string whole))
            whole = Encoding.UTF8.GetString(at.Value);
        return whole.Length <= enough ? whole : whole.Remove(enough) + "...";
    }
}
