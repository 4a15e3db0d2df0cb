using System;
using System.Text;
using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Reading;

/// <summary>What must hold of a text before and while its JSON is read.</summary>
internal static class JsonText
{
    private static readonly byte[] Beginnings = Encoding.ASCII.GetBytes("{[\"-/0123456789");
    private static readonly byte[] True = Encoding.ASCII.GetBytes("true");
    private static readonly byte[] False = Encoding.ASCII.GetBytes("false");
    private static readonly byte[] Null = Encoding.ASCII.GetBytes("null");
    private static readonly byte[] GameObjects = Encoding.ASCII.GetBytes("\"gameObjects\"");

    /// <summary>The text without a UTF-8 byte order mark, which Windows editors write.</summary>
    internal static ReadOnlyMemory<byte> WithoutMark(ReadOnlyMemory<byte> text) =>
        text.Span.StartsWith(new byte[] { 0xEF, 0xBB, 0xBF }) ? text.Slice(3) : text;

    /// <summary>Whether there is a text, it is none of another format, and it is UTF-8; the tokenizer does not look at that.</summary>
    internal static bool Check(ReadOnlySpan<byte> text, Findings findings)
    {
        int first = FirstSign(text);
        if (first < 0)
        {
            findings.AddAt(0, DiagnosticCodes.SceneEmpty);
            return false;
        }

        if (IsOfAnotherFormat(text.Slice(first)))
        {
            findings.AddAt(0, DiagnosticCodes.FormatMissing);
            return false;
        }

        int invalid = Utf8Check.FirstInvalid(text);
        if (invalid < 0)
            return true;
        findings.AddAt(invalid, DiagnosticCodes.JsonNotUtf8);
        return false;
    }

    /// <summary>Reports the one fault that ends the reading of a text.</summary>
    internal static void ReportBroken(JsonSyntaxException fault, int maxDepth, Findings findings)
    {
        if (fault.IsTooDeep)
            findings.AddAt(fault.Offset, DiagnosticCodes.JsonTooDeep, ("limit", Invariant.Text(maxDepth)));
        else
            findings.AddAt(fault.Offset, DiagnosticCodes.JsonSyntax, ("detail", fault.Message));
    }

    // <robot>, #usda, ISO-10303-21, PK of a zip: a letter or sign that begins neither a value of JSON nor a comment. A scene before which
    // something was typed is a broken one still.
    private static bool IsOfAnotherFormat(ReadOnlySpan<byte> text)
    {
        bool isSign = text[0] is > (byte)' ' and < 0x7F && Beginnings.AsSpan().IndexOf(text[0]) < 0;
        return isSign && !text.StartsWith(True) && !text.StartsWith(False) && !text.StartsWith(Null) && text.IndexOf(GameObjects) < 0;
    }

    // Where something else than blanks begins; -1: nowhere.
    private static int FirstSign(ReadOnlySpan<byte> text)
    {
        for (int i = 0; i < text.Length; i++)
        {
            if (text[i] is not ((byte)' ' or (byte)'\t' or (byte)'\r' or (byte)'\n'))
                return i;
        }

        return -1;
    }
}
