using System;
using System.IO;
using System.Linq;
using System.Text;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Tests.Conformance;
using NUnit.Framework;

namespace Kinefab.Tests.Document;

public class SceneFileTests
{
    private const string OneObject = """{"format": "kinefab.scene", "version": "1.0", "gameObjects": [{"id": "a", "name": "A"EXTRA}]}""";

    [Test]
    public void Load_NoSuchFile_IsADiagnostic() =>
        Assert.That(Codes(SceneFile.Load("/no/such/file.kinefab")), Is.EqualTo([DiagnosticCodes.SceneNotFound]));

    [Test]
    public void Load_AFolder_IsADiagnostic() =>
        Assert.That(Codes(SceneFile.Load(Path.GetTempPath())), Is.EqualTo([DiagnosticCodes.SourceIsFolder]));

    [Test]
    public void Load_PathWithZeroCharacter_IsADiagnostic() =>
        Assert.That(Codes(SceneFile.Load("a\0b")), Is.EqualTo([DiagnosticCodes.SourceUnreadable]));

    [Test]
    public void Load_FileAboveTheLimit_IsRefusedUnread()
    {
        string path = Path.GetTempFileName();
        try
        {
            using (FileStream stream = File.OpenWrite(path))
                stream.SetLength(SceneLimits.DefaultMaxFileBytes + 1);
            Assert.That(Codes(SceneFile.Load(path)), Is.EqualTo([DiagnosticCodes.SceneTooLarge]));
        }
        finally
        {
            File.Delete(path);
        }
    }

    [Test]
    public void Load_ABufferThatManyName_IsHeldOnce()
    {
        string folder = Directory.CreateTempSubdirectory().FullName;
        try
        {
            File.WriteAllBytes(Path.Combine(folder, "b.bin"), new byte[4096]);
            string buffers = string.Join(", ", Enumerable.Repeat("""{"uri": "b.bin", "byteLength": 4096, "sha256": "ad7facb2586fc6e966c004d7d1d16b024f5805ff7cb47c7a85dabd8b48892ca7"}""", 50));
            string path = Path.Combine(folder, "a.kinefab");
            File.WriteAllText(path, OneObject.Replace("EXTRA", "", StringComparison.Ordinal).Replace("}]}", "}], \"buffers\": [" + buffers + "]}", StringComparison.Ordinal));
            SceneReading reading = SceneFile.Load(path);
            Assert.That(reading.Document!.Buffers, Has.Count.EqualTo(50));
            Assert.That(reading.Document.Buffers.Select(buffer => buffer.Data!.Value).Distinct(), Has.Exactly(1).Items, "memory of one array");
        }
        finally
        {
            Directory.Delete(folder, recursive: true);
        }
    }

    /// <summary>Opening a pipe that nobody writes into waits for ever.</summary>
    [Test]
    [Platform("Linux,MacOsX")]
    [CancelAfter(30_000)]
    public void Load_APipeInPlaceOfABuffer_IsRefusedUnopened([Values] bool isLink)
    {
        string folder = Directory.CreateTempSubdirectory().FullName;
        try
        {
            string pipe = Path.Combine(folder, isLink ? "pipe" : "b.bin");
            using (var made = System.Diagnostics.Process.Start("mkfifo", [pipe]))
                made.WaitForExit();
            if (isLink)
                File.CreateSymbolicLink(Path.Combine(folder, "b.bin"), pipe);
            string path = Path.Combine(folder, "a.kinefab");
            File.WriteAllText(path, OneObject.Replace("EXTRA", "", StringComparison.Ordinal).Replace("}]}", """}], "buffers": [{"uri": "b.bin", "byteLength": 4096, "sha256": "ad7facb2586fc6e966c004d7d1d16b024f5805ff7cb47c7a85dabd8b48892ca7"}]}""", StringComparison.Ordinal));
            SceneDocument document = SceneFile.Load(path).Document!;
            Assert.That(Kinefab.Validation.SceneValidator.Validate(document).Report.Diagnostics.Select(d => d.Code), Is.EqualTo([DiagnosticCodes.BufferSize]));
        }
        finally
        {
            Directory.Delete(folder, recursive: true);
        }
    }

    [Test]
    public void Parse_TextAboveTheLimit_IsRefused()
    {
        var options = new SceneReadOptions { Limits = new SceneLimits { MaxFileBytes = 10 } };
        Assert.That(Codes(SceneFile.Parse(Encoding.UTF8.GetBytes(OneObject), null, options)), Is.EqualTo([DiagnosticCodes.SceneTooLarge]));
    }

    [Test]
    public void Parse_ArrayAboveTheLimit_EndsThere()
    {
        var options = new SceneReadOptions { Limits = new SceneLimits { MaxItems = 3 } };
        string text = """{"format": "kinefab.scene", "version": "1.0", "gameObjects": [1, 2, 3, 4, 5]}""";
        SceneReading reading = SceneFile.Parse(Encoding.UTF8.GetBytes(text), null, options);
        Assert.That(Codes(reading), Is.EqualTo(Enumerable.Repeat(DiagnosticCodes.TypeMismatch, 3).Append(DiagnosticCodes.ItemsTooMany)));
    }

    [Test]
    public void Parse_FindingsAboveTheLimit_AreCounted()
    {
        var options = new SceneReadOptions { Limits = new SceneLimits { MaxFindings = 2 } };
        string text = """{"format": "kinefab.scene", "version": "1.0", "gameObjects": [1, 2, 3, 4, 5]}""";
        SceneReading reading = SceneFile.Parse(Encoding.UTF8.GetBytes(text), null, options);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(reading.Report.Diagnostics, Has.Count.EqualTo(3));
            Assert.That(reading.Report.Diagnostics[2].Message, Does.StartWith("3 more"));
        }
    }

    [Test]
    public void Parse_FindingsOnOneLine_AreCountedInUtf16UnitsFromItsStart()
    {
        string text = """
            {"format": "kinefab.scene", "version": "1.0", "gameObjects":
            ["é", 1, "𝄞", 2,
             3]}
            """.ReplaceLineEndings("\n");
        SceneReading reading = SceneFile.Parse(Encoding.UTF8.GetBytes(text));
        Assert.That(reading.Report.Diagnostics.Select(found => (found.Line, found.Column)), Is.EqualTo(new (int?, int?)[] { (2, 2), (2, 7), (2, 10), (2, 16), (3, 2) }));
    }

    [TestCase(false, Severity.Warning)]
    [TestCase(true, Severity.Error)]
    public void Parse_UnknownField_IsAnErrorOnlyWhenStrict(bool strict, Severity expected)
    {
        byte[] text = Encoding.UTF8.GetBytes(OneObject.Replace("EXTRA", ", \"no_field\": 3", StringComparison.Ordinal));
        SceneReading reading = SceneFile.Parse(text, null, new SceneReadOptions { Strict = strict });
        using (Assert.EnterMultipleScope())
        {
            Assert.That(reading.Report.Diagnostics.Single().Severity, Is.EqualTo(expected));
            Assert.That(reading.Document is null, Is.EqualTo(strict));
        }
    }

    [Test]
    public void Parse_Extras_AreKeptAsTheyStood()
    {
        const string extras = """{"shop": [1.50, {"deep": null}], "é": "\u00e9"}""";
        byte[] text = Encoding.UTF8.GetBytes(OneObject.Replace("EXTRA", ", \"extras\": " + extras, StringComparison.Ordinal));
        Assert.That(SceneFile.Parse(text).Document!.GameObjects[0].ExtrasJson, Is.EqualTo(extras));
    }

    [Test]
    public void Parse_Span_DoesNotSeeLaterChanges()
    {
        byte[] text = Encoding.UTF8.GetBytes(OneObject.Replace("EXTRA", "", StringComparison.Ordinal));
        SceneDocument document = SceneFile.Parse(text.AsSpan()).Document!;
        text.AsSpan().Clear();
        Assert.That(Encoding.UTF8.GetString(document.Text.Span), Does.StartWith("{\"format\""));
    }

    [Test]
    public void Load_EveryFieldOfAConfigurableJoint_ReadsTheNumbersOfTheFile()
    {
        SceneReading reading = SceneFile.Load(Path.Combine(ConformanceCases.Folder, "valid", "configurable", "every_field.kinefab"));
        var joint = (ConfigurableJoint)reading.Document!.GameObjects[1].Components[1];
        using (Assert.EnterMultipleScope())
        {
            Assert.That(joint.ConnectedBody, Is.Zero);
            Assert.That((joint.BreakForce, joint.BreakTorque), Is.EqualTo((500, 50)));
            Assert.That((joint.EnableCollision, joint.EnablePreprocessing, joint.Closure, joint.Exact), Is.EqualTo((true, false, true, false)));
            Assert.That((joint.MassScale, joint.ConnectedMassScale), Is.EqualTo((2, 0.5)));
            Assert.That(joint.Because, Is.EqualTo(["Mate:7"]));
            Assert.That((joint.XMotion, joint.YMotion), Is.EqualTo((ConfigurableJointMotion.Limited, ConfigurableJointMotion.Free)));
            Assert.That((joint.LinearLimit.Limit, joint.LinearLimit.ContactDistance), Is.EqualTo((0.05, 0.001)));
            Assert.That((joint.LinearLimitSpring.Spring, joint.LinearLimitSpring.Damper), Is.EqualTo((1000, 10)));
            Assert.That((joint.LowAngularXLimit.Limit, joint.LowAngularXLimit.Bounciness, joint.HighAngularXLimit.Limit), Is.EqualTo((-10, 0.2, 80)));
            Assert.That((joint.AngularYLimit.Limit, joint.AngularZLimit.Limit), Is.EqualTo((20, 30)));
            Assert.That(joint.TargetPosition, Is.EqualTo(new Vector3d(0.01, 0, 0)));
            Assert.That(joint.TargetRotation, Is.EqualTo(new Quaterniond(0.0871557427, 0, 0, 0.9961946981)));
            Assert.That(joint.TargetAngularVelocity, Is.EqualTo(new Vector3d(0.5, 0, 0)));
            Assert.That((joint.XDrive.PositionSpring, joint.XDrive.PositionDamper, joint.XDrive.MaximumForce), Is.EqualTo((100, 5, 40)));
            Assert.That((joint.ZDrive.UseAcceleration, joint.ZDrive.MaximumForce), Is.EqualTo((true, double.PositiveInfinity)));
            Assert.That((joint.ProjectionMode, joint.ProjectionDistance, joint.ProjectionAngle), Is.EqualTo((JointProjectionMode.PositionAndRotation, 0.01, 5)));
        }
    }

    private static string[] Codes(SceneReading reading)
    {
        Assert.That(reading.Document, Is.Null);
        return reading.Report.Diagnostics.Select(found => found.Code).ToArray();
    }
}
