using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json;

namespace Kinefab.Tests.Conformance;

/// <summary>The cases of tests/conformance/manifest.json.</summary>
internal static class ConformanceCases
{
    internal static string Folder { get; } = Find();

    internal static IReadOnlyList<ConformanceCase> All { get; } = Read();

    private static string Find()
    {
        for (DirectoryInfo? at = new(AppContext.BaseDirectory); at is not null; at = at.Parent)
        {
            string folder = Path.Combine(at.FullName, "tests", "conformance");
            if (File.Exists(Path.Combine(folder, "manifest.json")))
                return folder;
        }

        throw new DirectoryNotFoundException("There is no tests/conformance above " + AppContext.BaseDirectory);
    }

    private static ConformanceCase[] Read()
    {
        using JsonDocument manifest = JsonDocument.Parse(File.ReadAllText(Path.Combine(Folder, "manifest.json")));
        return manifest.RootElement.GetProperty("cases").EnumerateArray().Select(entry => new ConformanceCase(
            entry.GetProperty("path").GetString()!,
            entry.GetProperty("kind").GetString()!,
            entry.TryGetProperty("expect", out JsonElement expect) ? expect.GetString()! : "")).ToArray();
    }
}

/// <summary>One case: a file, what kind of file it is, and what is expected of it.</summary>
internal sealed record ConformanceCase(string Path, string Kind, string Expect)
{
    internal string FullPath => System.IO.Path.Combine(ConformanceCases.Folder, Path);

    /// <summary>The expected findings, or none where no report stands beside the file.</summary>
    internal string[] ExpectedFindings()
    {
        string report = System.IO.Path.ChangeExtension(FullPath, ".report.json");
        if (!File.Exists(report))
            return [];
        using JsonDocument json = JsonDocument.Parse(File.ReadAllText(report));
        return json.RootElement.EnumerateArray().Select(entry =>
        {
            string line = entry.TryGetProperty("line", out JsonElement number) ? " line " + number.GetRawText() : "";
            return $"{entry.GetProperty("severity").GetString()} {entry.GetProperty("code").GetString()} at '{entry.GetProperty("pointer").GetString()}'{line}";
        }).ToArray();
    }

    public override string ToString() => Path;
}
