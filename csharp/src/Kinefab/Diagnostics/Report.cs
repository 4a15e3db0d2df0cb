using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Linq;

namespace Kinefab.Diagnostics;

/// <summary>What was found, in the order of the places in the file.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class Report
{
    /// <summary>Of findings, in the order of their places.</summary>
    /// <param name="diagnostics">Not changed afterwards.</param>
    public Report(IReadOnlyList<Diagnostic> diagnostics) => Diagnostics = diagnostics ?? throw new ArgumentNullException(nameof(diagnostics));

    /// <summary>Nothing was found.</summary>
    public static Report Empty { get; } = new(Array.Empty<Diagnostic>());

    /// <summary>The findings.</summary>
    public IReadOnlyList<Diagnostic> Diagnostics { get; }

    /// <summary>Whether there is an error among them.</summary>
    public bool HasErrors => Count(Severity.Error) > 0;

    /// <summary>How many there are of a severity.</summary>
    /// <param name="severity">Just this one, not the graver ones.</param>
    /// <returns>0 or more.</returns>
    public int Count(Severity severity) => Diagnostics.Count(found => found.Severity == severity);

    /// <summary>1 error, 2 warnings; or no findings; the first one behind it.</summary>
    public override string ToString()
    {
        if (Diagnostics.Count == 0)
            return "no findings";
        string[] counts = new[] { (Severity.Error, "error"), (Severity.Warning, "warning"), (Severity.Info, "info") }
            .Where(kind => Count(kind.Item1) > 0)
            .Select(kind => $"{Count(kind.Item1)} {kind.Item2}{(Count(kind.Item1) == 1 || kind.Item1 == Severity.Info ? "" : "s")}")
            .ToArray();
        return $"{string.Join(", ", counts)}; first: {Diagnostics[0]}";
    }

    /// <summary>These findings, then those of another report.</summary>
    /// <param name="other">Not changed.</param>
    /// <returns>A new report; neither of the two changes.</returns>
    public Report Concat(Report other)
    {
        if (other is null)
            throw new ArgumentNullException(nameof(other));
        return new Report(Diagnostics.Concat(other.Diagnostics).ToArray());
    }
}
