using System;
using System.Collections.Generic;
using System.Linq;

namespace Kinefab.Diagnostics;

/// <summary>What was found, in the order of the places in the file.</summary>
public sealed class Report
{
    internal Report(IReadOnlyList<Diagnostic> diagnostics) => Diagnostics = diagnostics;

    /// <summary>Nothing was found.</summary>
    public static Report Empty { get; } = new(Array.Empty<Diagnostic>());

    /// <summary>The findings.</summary>
    public IReadOnlyList<Diagnostic> Diagnostics { get; }

    /// <summary>Whether there is an error among them.</summary>
    public bool HasErrors => Count(Severity.Error) > 0;

    /// <summary>How many there are of a severity.</summary>
    public int Count(Severity severity) => Diagnostics.Count(found => found.Severity == severity);

    /// <summary>These findings, then those of another report.</summary>
    public Report Concat(Report other)
    {
        if (other is null)
            throw new ArgumentNullException(nameof(other));
        return new Report(Diagnostics.Concat(other.Diagnostics).ToArray());
    }
}
