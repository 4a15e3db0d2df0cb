using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json;
using Kinefab.Diagnostics;
using NUnit.Framework;

namespace Kinefab.Tests.Conformance;

/// <summary>CAD sources are read by Python alone; here their expected findings are held against the table C# embeds.</summary>
public class SourceCaseTests
{
    private static IEnumerable<string> Paths => ConformanceCases.All.Where(entry => entry.Kind == "source").Select(entry => entry.Path);

    [TestCaseSource(nameof(Paths))]
    public void Source_OfTheManifest_ExpectsFindingsOfTheTable(string path)
    {
        string file = Path.Combine(ConformanceCases.Folder, path);
        string report = Path.Combine(Path.GetDirectoryName(file)!, Path.GetFileName(file).Split('.')[0] + ".report.json");
        using JsonDocument expected = JsonDocument.Parse(File.ReadAllText(report));

        foreach (JsonElement finding in expected.RootElement.EnumerateArray())
        {
            Assert.That(DiagnosticTable.Entries.TryGetValue(finding.GetProperty("code").GetString()!, out DiagnosticTable.Entry? entry), Is.True);
            Assert.That(SeverityNames.Parse(finding.GetProperty("severity").GetString()!), Is.EqualTo(entry!.Severity));
        }
    }
}
