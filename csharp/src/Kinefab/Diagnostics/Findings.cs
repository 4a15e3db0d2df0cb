using System;
using System.Collections.Generic;

namespace Kinefab.Diagnostics;

/// <summary>
/// Collects findings while a file is read or validated.  A finding knows one half of its place (a byte offset or a
/// pointer); the other half is worked out once, at the end, and only when something was found.
/// </summary>
internal sealed class Findings
{
    private readonly List<Finding> list = new();
    private readonly int limit;

    // Of a full list, before this one stand those that an error may take the place of.
    private int full;

    /// <summary>An empty list.</summary>
    /// <param name="limit">Most that it holds; one at least, so that what has an error tells one.</param>
    internal Findings(int limit)
    {
        this.limit = Math.Max(1, limit);
        full = this.limit;
    }

    internal IReadOnlyList<Finding> List => list;

    /// <summary>How many findings are not in the list because it was full: errors only where it holds nothing else.</summary>
    internal int Omitted { get; private set; }

    internal int Errors { get; private set; }

    internal void Clear()
    {
        list.Clear();
        full = limit;
        Omitted = 0;
        Errors = 0;
    }

    internal void AddAt(long offset, string code, params (string Name, string Value)[] values) =>
        Add(null, offset, code, values, null);

    internal void AddAt(long offset, Severity severity, string code, params (string Name, string Value)[] values) =>
        Add(null, offset, code, values, severity);

    internal void Add(string pointer, string code, params (string Name, string Value)[] values) =>
        Add(pointer, -1, code, values, null);

    private void Add(string? pointer, long offset, string code, (string Name, string Value)[] values, Severity? graded)
    {
        DiagnosticTable.Entry entry = DiagnosticTable.Entries[code];
        Severity severity = graded ?? entry.Severity;
        if (severity == Severity.Error)
            Errors++;
        if (list.Count == limit && !(severity == Severity.Error && TryMakeRoom()))
        {
            Omitted++;
            return;
        }

        list.Add(new Finding(
            code,
            severity,
            DiagnosticTable.Fill(entry.Message, values),
            DiagnosticTable.Fill(entry.Remedy, values),
            pointer,
            offset));
    }

    // A thousand warnings before it must not hide the one error that says why a file is refused.
    private bool TryMakeRoom()
    {
        while (full > 0)
        {
            full--;
            if (list[full].Severity != Severity.Error)
            {
                list.RemoveAt(full);
                Omitted++;
                return true;
            }
        }

        return false;
    }

    internal sealed class Finding
    {
        internal Finding(string code, Severity severity, string message, string remedy, string? pointer, long offset)
        {
            Code = code;
            Severity = severity;
            Message = message;
            Remedy = remedy;
            Pointer = pointer;
            Offset = offset;
        }

        internal string Code { get; }

        internal Severity Severity { get; }

        internal string Message { get; }

        internal string Remedy { get; }

        /// <summary>Null: known by offset alone.</summary>
        internal string? Pointer { get; }

        /// <summary>Negative: known by pointer alone.</summary>
        internal long Offset { get; }
    }
}
