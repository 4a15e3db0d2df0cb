using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;
using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Reading;

/// <summary>Completes findings: pointer from offset, offset from pointer, line and column from offset.</summary>
internal static class FindingPlaces
{
    /// <summary>The report, in the order of the places; without a text there are no lines.</summary>
    internal static Report Resolve(Findings findings, ReadOnlySpan<byte> text, bool hasText)
    {
        if (findings.List.Count == 0)
            return Report.Empty;
        long[] offsets = Offsets(findings.List, text);
        int[] order = Enumerable.Range(0, offsets.Length).OrderBy(i => offsets[i]).ToArray();
        long[] sorted = order.Select(i => offsets[i]).ToArray();
        string[] pointers = PointerFinder.PointersAt(text, sorted);
        var lines = new LineCounter(text);
        var diagnostics = new List<Diagnostic>();
        for (int i = 0; i < order.Length; i++)
        {
            Findings.Finding found = findings.List[order[i]];
            (int? line, int? column) = !hasText ? (null, null) : lines.At(sorted[i]);
            diagnostics.Add(new Diagnostic(
                found.Code, found.Severity, found.Message, found.Remedy, found.Pointer ?? pointers[i], line, column));
        }

        if (findings.Omitted > 0)
            diagnostics.Add(Omitted(findings.Omitted));
        return new Report(diagnostics);
    }

    private static long[] Offsets(IReadOnlyList<Findings.Finding> list, ReadOnlySpan<byte> text)
    {
        long[] offsets = list.Select(found => Math.Max(0, found.Offset)).ToArray();
        string[] wanted = list.Select(found => found.Pointer ?? "").ToArray();
        if (text.IsEmpty || wanted.All(pointer => pointer.Length == 0))
            return offsets;
        long[] found = PointerFinder.OffsetsOf(text, wanted);
        for (int i = 0; i < offsets.Length; i++)
        {
            if (wanted[i].Length > 0)
                offsets[i] = found[i];
        }

        return offsets;
    }

    private static Diagnostic Omitted(int count)
    {
        DiagnosticTable.Entry entry = DiagnosticTable.Entries[DiagnosticCodes.FindingsOmitted];
        string message = DiagnosticTable.Fill(entry.Message, new[] { ("count", Invariant.Text(count)) });
        return new Diagnostic(DiagnosticCodes.FindingsOmitted, entry.Severity, message, entry.Remedy, "", null, null);
    }

    /// <summary>Lines and columns of rising offsets, in one pass: a line that holds many findings is read once, too.</summary>
    private ref struct LineCounter
    {
        private readonly ReadOnlySpan<byte> text;
        private int at;
        private int line;
        private int column;

        internal LineCounter(ReadOnlySpan<byte> text)
        {
            this.text = text;
            at = 0;
            line = 1;
            column = 1;
        }

        internal (int? Line, int? Column) At(long offset)
        {
            int end = (int)Math.Min(offset, text.Length);
            int newline;
            while ((newline = text.Slice(at, end - at).IndexOf((byte)'\n')) >= 0)
            {
                at += newline + 1;
                line++;
                column = 1;
            }

            column += Encoding.UTF8.GetCharCount(text.Slice(at, end - at));
            at = end;
            return (line, column);
        }
    }
}
