using System.Collections.Generic;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Advice.Findings;

/// <summary>Makes findings of codes, places and measures.</summary>
internal static class FindingText
{
    /// <summary>A finding whose remedy is the best of what was tried.</summary>
    public static AdviceFinding Make(
        string code, Severity severity, string pointer, string id, AdviceMeasure before, double score,
        IReadOnlyList<TriedChange> tried, TriedChange? best, params (string Name, string Value)[] values)
    {
        DiagnosticTable.Entry entry = DiagnosticTable.Entries[code];
        string message = DiagnosticTable.Fill(entry.Message, values);
        string remedy = DiagnosticTable.Fill(entry.Remedy, new[] { ("advice", Advice(before, score, tried, best)) });
        return new AdviceFinding(new Diagnostic(code, severity, message, remedy, pointer, null, null), id, before, score, tried, best);
    }

    public static AdviceFinding Make(
        string code, Severity severity, string pointer, string id, AdviceMeasure before, double score,
        Treatment treatment, params (string Name, string Value)[] values) =>
        Make(code, severity, pointer, id, before, score, treatment.Tried, treatment.Best, values);

    private static string Advice(AdviceMeasure before, double score, IReadOnlyList<TriedChange> tried, TriedChange? best)
    {
        if (best is not null)
            return $"{best.Change}: {best.After} instead of {before}{best.Cost}.";
        if (score < 1)
            return "Nothing to do.";
        return tried.Count == 0 ? "Nothing was tried."
            : tried.Count == 1 ? "The one change tried against it does not help."
            : $"None of {Invariant.Text(tried.Count)} changes tried against it helps.";
    }
}
