using System.Diagnostics;
using Kinefab.Diagnostics;

namespace Kinefab.Document;

/// <summary>What came of reading a scene file.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class SceneReading
{
    internal SceneReading(SceneDocument? document, Report report)
    {
        Document = document;
        Report = report;
    }

    /// <summary>The scene; null when the report has errors.</summary>
    public SceneDocument? Document { get; }

    /// <summary>What was found: of the file's shape, not of its meaning.</summary>
    public Report Report { get; }

    /// <summary>Whether there is a document, and the findings.</summary>
    public override string ToString() => $"{(Document is null ? "not read" : "read")}; {Report}";
}
