using System;
using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Reading;

/// <summary>What must hold of a text before and while its JSON is read.</summary>
internal static class JsonText
{
    /// <summary>The text without a UTF-8 byte order mark, which Windows editors write.</summary>
    internal static ReadOnlyMemory<byte> WithoutMark(ReadOnlyMemory<byte> text) =>
        text.Span.StartsWith(new byte[] { 0xEF, 0xBB, 0xBF }) ? text.Slice(3) : text;

    /// <summary>Whether there is a text and it is UTF-8; the tokenizer does not look at that.</summary>
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
    internal static void ReportBroken(JsonSyntaxException fault, int maxDepth, Findings findings)
    {
        if (fault.IsTooDeep)
            findings.AddAt(fault.Offset, DiagnosticCodes.JsonTooDeep, ("limit", Invariant.Text(maxDepth)));
        else
            findings.AddAt(fault.Offset, DiagnosticCodes.JsonSyntax, ("detail", fault.Message));
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
}
