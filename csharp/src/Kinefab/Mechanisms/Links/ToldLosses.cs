using System;
using System.Collections.Generic;
using Kinefab.Document;

namespace Kinefab.Mechanisms;

/// <summary>The file's own report, less what its joints lost and links hold.</summary>
internal sealed class ToldLosses
{
    private readonly List<ReportEntry> entries;

    internal ToldLosses(IReadOnlyList<ReportEntry> report) => entries = new List<ReportEntry>(report);

    internal IReadOnlyList<ReportEntry> Left => entries;

    /// <summary>Takes back that a feature was lost, of the whole joint or of one of its coordinates.</summary>
    internal void IsKept(string feature, string code)
    {
        for (int i = 0; i < entries.Count; i++)
        {
            bool isIt = entries[i].Feature == feature || entries[i].Feature.StartsWith(feature + ", ", StringComparison.Ordinal);
            if (isIt && entries[i].Code == code)
                entries[i] = entries[i] with { Outcome = Outcome.Kept, Code = null, Severity = null, Message = null };
        }
    }
}
