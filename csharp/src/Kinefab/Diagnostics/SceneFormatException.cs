using System;
using System.Linq;

namespace Kinefab.Diagnostics;

/// <summary>A scene cannot be used; <see cref="Report"/> says why.  The only exception that faulty data can cause.</summary>
public sealed class SceneFormatException : Exception
{
    /// <summary>From a report with errors.</summary>
    /// <param name="report">Its errors become the message, one a line.</param>
    public SceneFormatException(Report report)
        : base(Describe(report))
    {
        Report = report;
    }

    /// <summary>What was found.</summary>
    public Report Report { get; }

    private static string Describe(Report report)
    {
        if (report is null)
            throw new ArgumentNullException(nameof(report));
        return string.Join("\n", report.Diagnostics.Where(found => found.Severity == Severity.Error));
    }
}
