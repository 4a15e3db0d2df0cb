using System;
using System.Text.Json;
using Kinefab.Diagnostics;

namespace Kinefab.Json;

/// <summary>What must hold of a text before and while its JSON is read.</summary>
internal static class JsonText
{
    /// <summary>The text without a UTF-8 byte order mark, which Windows editors write.</summary>
    internal static ReadOnlyMemory<byte> WithoutMark(ReadOnlyMemory<byte> text) =>
        text.Span.StartsWith(new byte[] { 0xEF, 0xBB, 0xBF }) ? text.Slice(3) : text;

    /// <summary>Whether there is a text and it is UTF-8; Utf8JsonReader does not look into strings.</summary>
    internal static bool Check(ReadOnlySpan<byte> text, Findings findings)
    {
        if (IsBlank(text))
        {
            findings.AddAt(0, DiagnosticCodes.SceneEmpty);
            return false;
        }

        int invalid = Utf8Check.FirstInvalid(text);
        if (invalid < 0)
            return true;
        findings.AddAt(invalid, DiagnosticCodes.JsonNotUtf8);
        return false;
    }

    /// <summary>Reports the one fault that ends the reading of a text.</summary>
    internal static void ReportBroken(ReadOnlySpan<byte> text, JsonException fault, bool deepest, int maxDepth, Findings findings)
    {
        long offset = Offset(text, fault.LineNumber ?? 0, fault.BytePositionInLine ?? 0);
        if (deepest && offset < text.Length && text[(int)offset] is (byte)'{' or (byte)'[')
        {
            findings.AddAt(offset, DiagnosticCodes.JsonTooDeep, ("limit", Invariant.Text(maxDepth)));
            return;
        }

        string detail = fault.Message;
        int tail = detail.IndexOf(" LineNumber:", StringComparison.Ordinal);
        if (tail >= 0)
            detail = detail.Substring(0, tail);
        findings.AddAt(offset, DiagnosticCodes.JsonSyntax, ("detail", detail.TrimEnd('.')));
    }

    private static bool IsBlank(ReadOnlySpan<byte> text)
    {
        foreach (byte b in text)
        {
            if (b is not ((byte)' ' or (byte)'\t' or (byte)'\r' or (byte)'\n'))
                return false;
        }

        return true;
    }

    private static long Offset(ReadOnlySpan<byte> text, long line, long column)
    {
        int start = 0;
        for (; line > 0; line--)
            start += text.Slice(start).IndexOf((byte)'\n') + 1;
        return Math.Min(start + column, text.Length);
    }
}
