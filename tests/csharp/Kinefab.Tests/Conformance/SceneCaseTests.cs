using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Conformance;

public class SceneCaseTests
{
    private static IEnumerable<string> ScenePaths => ConformanceCases.All.Where(entry => entry.Kind == "scene").Select(entry => entry.Path);

    private static readonly string[] Folders = ["valid", "invalid"];

    private static readonly string[] Stages = ["parse", "structure", "value", "buffer", "unity"];

    [TestCaseSource(nameof(ScenePaths))]
    public void Scene_OfTheManifest_GivesExactlyTheExpectedFindings(string path)
    {
        ConformanceCase entry = ConformanceCases.All.Single(candidate => candidate.Path == path);
        Report report = FullReport(entry.FullPath);
        string[] expected = entry.ExpectedFindings();
        string[] found = report.Diagnostics
            .Select((diagnostic, i) => Describe(diagnostic, i < expected.Length && expected[i].Contains(" line ")))
            .ToArray();
        using (Assert.EnterMultipleScope())
        {
            Assert.That(found, Is.EqualTo(expected));
            Assert.That(report.HasErrors ? "invalid" : "valid", Is.EqualTo(entry.Expect));
            // A damaged binary file has no lines to name.
            Assert.That(report.Diagnostics.Where(diagnostic => !diagnostic.Code.StartsWith("CONTAINER_", StringComparison.Ordinal)).Select(diagnostic => diagnostic.Line), Has.All.GreaterThan(0));
            Assert.That(report.Diagnostics.Select(diagnostic => diagnostic.Message + diagnostic.Remedy), Has.None.Match(@"\{\w+\}"));
            Assert.That(report.Diagnostics.Select(diagnostic => diagnostic.Message), Has.None.Match(@"\.\d{10,}"), "what rounding adds to a measured number");
        }
    }

    [Test]
    public void Manifest_AgainstTheFolders_ListsEveryFileAndNoOther()
    {
        IEnumerable<string> files = Folders
            .SelectMany(folder => Directory.EnumerateFiles(Path.Combine(ConformanceCases.Folder, folder), "*.kinefab", SearchOption.AllDirectories))
            .Select(file => Path.GetRelativePath(ConformanceCases.Folder, file).Replace('\\', '/'));
        Assert.That(files, Is.EquivalentTo(ScenePaths));
    }

    [Test]
    public void Manifest_EveryKind_HasARunner()
    {
        string[] kinds = ["scene", "frames", "joints", "source"];
        Assert.That(ConformanceCases.All.Select(entry => entry.Kind).Distinct(), Is.SubsetOf(kinds));
    }

    [Test]
    public void InvalidCases_Together_CoverEveryCodeOfAScene()
    {
        IEnumerable<string> codes = DiagnosticTable.Entries.Where(entry => Stages.Contains(entry.Value.Stage)).Select(entry => entry.Key);
        IEnumerable<string> covered = ConformanceCases.All
            .Where(entry => entry.Kind == "scene")
            .SelectMany(entry => entry.ExpectedFindings())
            .Select(finding => finding.Split(' ')[1]);
        Assert.That(codes.Intersect(OwnCodes.All).Except(covered), Is.Empty);
    }

    private static Report FullReport(string path)
    {
        SceneReading reading = SceneFile.Load(path);
        return reading.Document is null ? reading.Report : reading.Report.Concat(SceneValidator.Validate(reading.Document).Report);
    }

    private static string Describe(Diagnostic found, bool withLine)
    {
        string line = withLine ? $" line {found.Line}" : "";
        return $"{SeverityNames.ToJson(found.Severity)} {found.Code} at '{found.Pointer}'{line}";
    }
}
