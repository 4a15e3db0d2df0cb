using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text;
using FsCheck;
using FsCheck.Fluent;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Tests.Conformance;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Document;

/// <summary>Whatever happens to a file, there is a report or a valid scene; an exception would fail these tests.</summary>
public class DamagedFileTests
{
    private static readonly byte[][] Texts = ConformanceCases.All
        .Where(entry => entry.Kind == "scene" && entry.Path.StartsWith("valid/", StringComparison.Ordinal))
        .Select(entry => File.ReadAllBytes(entry.FullPath))
        .ToArray();

    [Test]
    public void Read_AnyByteChangedOrRemoved_GivesAReportOrAScene()
    {
        Prop.ForAll(ArbMap.Default.ArbFor<int>(), seed =>
        {
            var random = new System.Random(seed);
            List<byte> text = Texts[random.Next(Texts.Length)].ToList();
            for (int fault = random.Next(1, 4); fault > 0; fault--)
            {
                int at = random.Next(text.Count);
                if (random.Next(2) == 0)
                    text[at] = Damage(random);
                else
                    text.RemoveAt(at);
            }

            return Holds(text.ToArray());
        }).Check(Config.QuickThrowOnFailure.WithMaxTest(1500));
    }

    [Test]
    public void Read_CutAnywhere_GivesAReport()
    {
        byte[] text = Texts.MaxBy(candidate => candidate.Length)!;
        for (int length = 0; length < text.Length - 2; length++)
        {
            SceneReading reading = SceneFile.Parse(text.AsSpan(0, length));
            Assert.That((reading.Document is null, reading.Report.HasErrors), Is.EqualTo((true, true)), $"{length} bytes");
        }
    }

    [TestCase("{")]
    [TestCase("[")]
    [TestCase("{\"a\":")]
    [TestCase("\"")]
    [TestCase("\\")]
    [TestCase("0")]
    [TestCase(" ")]
    [TestCase("\0")]
    [TestCase("{\"gameObjects\":[")]
    public void Read_AFloodOfOneThing_EndsWithAReport(string part)
    {
        byte[] text = Encoding.UTF8.GetBytes(new StringBuilder().Insert(0, part, 2_000_000 / part.Length).ToString());
        Assert.That(SceneFile.Parse(text).Report.HasErrors);
    }

    [Test]
    public void Read_AMillionFaults_ReportsTheFirstThousand()
    {
        string text = "{\"format\":\"kinefab.scene\",\"version\":\"1.0\",\"gameObjects\":[" + string.Join(",", Enumerable.Repeat("7", 1_000_000)) + "]}";
        Assert.That(SceneFile.Parse(Encoding.UTF8.GetBytes(text)).Report.Diagnostics, Has.Count.EqualTo(1001));
    }

    [Test]
    public void Read_ErrorsBehindMoreWarningsThanAreKept_AreToldInTheirOrder()
    {
        SceneReading reading = SceneFile.Parse(Encoding.UTF8.GetBytes(Scene("""{"type": "Nope"}, {"type": "No"}""", unknown: 1200)));
        using (Assert.EnterMultipleScope())
        {
            Assert.That(reading.Document, Is.Null);
            Assert.That(reading.Report.Diagnostics.Where(found => found.Severity == Severity.Error).Select(found => found.Pointer), Is.EqualTo(["/gameObjects/0/components/0/type", "/gameObjects/0/components/1/type"]));
            Assert.That(reading.Report.Diagnostics, Has.Count.EqualTo(1001));
            Assert.That(reading.Report.Diagnostics[^1].Message, Does.StartWith("202 more"));
        }
    }

    [Test]
    public void Validate_AnErrorBehindMoreFindingsThanAreKept_IsTold()
    {
        string text = Scene("""{"type": "BoxCollider", "size": [-1, 1, 1]}""");
        SceneDocument one = SceneFile.Parse(Encoding.UTF8.GetBytes(text)).Document!;
        int warnings = SceneValidator.Validate(one).Report.Count(Severity.Warning);
        SceneValidation validation = SceneValidator.Validate(one with { GameObjects = [one.GameObjects[0], one.GameObjects[0]] }, new SceneLimits { MaxFindings = 1 });
        Assert.That((warnings, validation.Scene is null, validation.Report.HasErrors), Is.EqualTo((1, true, true)));
    }

    [Test]
    public void Read_WithoutRoomForFindings_TellsOneErrorAllTheSame()
    {
        var none = new SceneReadOptions { Limits = new SceneLimits { MaxFindings = 0 } };
        Assert.That(SceneFile.Parse("{}"u8, null, none).Report.HasErrors);
    }

    [TestCase(200)]
    [TestCase(100_000)]
    public void Read_DeeperThanTheDefault_IsRefusedOrValidatedAndWritten(int depth)
    {
        string extras = new StringBuilder().Insert(0, "{\"a\":", depth).Append('1').Append('}', depth).ToString();
        string text = Scene("").Replace("\"gameObjects\"", $"\"extras\": {extras}, \"gameObjects\"", StringComparison.Ordinal)
            .Replace("\"transform\": {}", "\"transform\": {\"localScale\": [0, 1, 1]}", StringComparison.Ordinal);
        SceneReading reading = SceneFile.Parse(Encoding.UTF8.GetBytes(text), null, new SceneReadOptions { Limits = new SceneLimits { MaxDepth = int.MaxValue } });
        if (depth > 256)
        {
            Assert.That(reading.Report.Diagnostics.Single().Code, Is.EqualTo(DiagnosticCodes.JsonTooDeep));
            return;
        }

        Assert.That(SceneValidator.Validate(reading.Document!).Report.Diagnostics.Select(found => found.Line), Is.Not.Empty.And.All.EqualTo(1));
        Assert.That(() => SceneFile.Save(reading.Document!, Stream.Null), Throws.Nothing);
    }

    private static string Scene(string components, int unknown = 0)
    {
        string fields = string.Concat(Enumerable.Range(0, unknown).Select(i => $"\"unknown{i}\": 0, "));
        return $$"""{"format": "kinefab.scene", "version": "1.0", {{fields}}"gameObjects": [{"id": "A", "name": "A", "transform": {}, "components": [{{components}}]}]}""";
    }

    /// <summary>Bytes that mean something to JSON, and any others.</summary>
    private static byte Damage(System.Random random)
    {
        ReadOnlySpan<byte> telling = "{}[]\",:\\0123456789-+eE.tfn \n\0u"u8;
        return random.Next(3) == 0 ? (byte)random.Next(256) : telling[random.Next(telling.Length)];
    }

    private static bool Holds(byte[] text)
    {
        SceneReading reading = SceneFile.Parse(text, _ => new byte[72]);
        if (reading.Document is null)
            return reading.Report.HasErrors && reading.Report.Diagnostics.All(found => (found.Line > 0 && found.Column > 0) || found.Code.StartsWith("CONTAINER_", StringComparison.Ordinal));
        SceneValidation validation = SceneValidator.Validate(reading.Document);
        return validation.Report.HasErrors == (validation.Scene is null);
    }
}
