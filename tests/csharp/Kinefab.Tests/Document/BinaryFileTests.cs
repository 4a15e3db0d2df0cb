using System;
using System.Buffers.Binary;
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

/// <summary>A scene in one file, whole and damaged: whatever happens to it, there is a report or the scene.</summary>
public class BinaryFileTests
{
    // 5 bytes in a chunk of 8, so that there is padding behind both chunks.
    private static readonly byte[] Small = Bytes(new SceneDocument { Buffers = [new SceneBuffer { Data = new byte[] { 1, 2, 3, 4, 5 } }], GameObjects = [new GameObject { Id = "a", Name = "A" }] });

    private static readonly byte[] Lever = Bytes(SceneFile.Load(Path.Combine(ConformanceCases.Folder, "..", "..", "fixtures", "lever", "lever.kinefab")).Document!);

    [Test]
    public void Parse_OneFile_TakesTheBufferWithoutACopy()
    {
        byte[] file = (byte[])Lever.Clone();
        SceneDocument document = SceneFile.Parse(file).Document!;
        ReadOnlyMemory<byte> data = document.Buffers[0].Data!.Value;
        Assert.That(System.Runtime.InteropServices.MemoryMarshal.TryGetArray(data, out ArraySegment<byte> segment));
        Assert.That((segment.Array, segment.Count), Is.EqualTo((file, data.Length)));
        Assert.That(segment.Offset % 4, Is.Zero);
    }

    [Test]
    public void Load_EveryWay_TakesOneFile()
    {
        string path = Path.GetTempFileName();
        try
        {
            File.WriteAllBytes(path, Lever);
            using FileStream stream = File.OpenRead(path);
            int[] counts =
            [
                ValidScene.Load(path).Document.Buffers[0].Data!.Value.Length,
                ValidScene.Load(stream).Document.Buffers[0].Data!.Value.Length,
                ValidScene.Load((ReadOnlyMemory<byte>)Lever).Document.Buffers[0].Data!.Value.Length,
                Kinefab.Dynamics.World.Load(path).Scene.Document.Buffers[0].Data!.Value.Length,
                Kinefab.Kinematics.Mechanism.Load(path).Scene.Document.Buffers[0].Data!.Value.Length,
            ];
            Assert.That(counts, Is.All.EqualTo(57912));
        }
        finally
        {
            File.Delete(path);
        }
    }

    [Test]
    public void Parse_CutAnywhere_GivesAReport()
    {
        for (int length = 0; length < Small.Length; length++)
        {
            SceneReading reading = SceneFile.Parse(Small.AsSpan(0, length));
            Assert.That((reading.Document is null, reading.Report.HasErrors), Is.EqualTo((true, true)), $"{length} bytes");
            if (length >= 4)
                Assert.That(Codes(reading), Is.EqualTo([DiagnosticCodes.ContainerInvalid]), $"{length} bytes");
        }
    }

    [TestCase(4, 2u, DiagnosticCodes.ContainerVersionUnsupported)]
    [TestCase(4, 0u, DiagnosticCodes.ContainerVersionUnsupported)]
    [TestCase(8, 0u, DiagnosticCodes.ContainerInvalid)]
    [TestCase(8, uint.MaxValue, DiagnosticCodes.ContainerInvalid)]
    [TestCase(12, 0u, DiagnosticCodes.ContainerInvalid)]
    [TestCase(12, uint.MaxValue, DiagnosticCodes.ContainerInvalid)]
    [TestCase(12, 0x7FFFFFFCu, DiagnosticCodes.ContainerInvalid)]
    [TestCase(12, 5u, DiagnosticCodes.ContainerInvalid)]
    [TestCase(16, 0x004E4942u, DiagnosticCodes.ContainerInvalid)]
    public void Parse_AWrongNumber_IsTheOneFinding(int at, uint number, string code)
    {
        byte[] file = (byte[])Small.Clone();
        BinaryPrimitives.WriteUInt32LittleEndian(file.AsSpan(at), number);
        Assert.That(Codes(SceneFile.Parse(file)), Is.EqualTo([code]));
    }

    [TestCase("JSON")]
    [TestCase("BIN\0")]
    public void Parse_AChunkTwice_IsAFinding(string kind) =>
        Assert.That(Codes(SceneFile.Parse(WithChunk(Small, kind, 4))), Is.EqualTo([DiagnosticCodes.ContainerInvalid]));

    [Test]
    public void Parse_AChunkOfALaterVersion_IsSteppedOver() =>
        Assert.That(SceneFile.Parse(WithChunk(Small, "NEXT", 8)).Document!.Buffers[0].Data!.Value.ToArray(), Is.EqualTo(new byte[] { 1, 2, 3, 4, 5 }));

    [Test]
    public void Parse_FaultsInTheText_HaveTheirLines()
    {
        byte[] file = Encoding.Latin1.GetBytes(Encoding.Latin1.GetString(Small).Replace("\"name\": \"A\"", "\"nome\": \"A\"", StringComparison.Ordinal));
        Diagnostic finding = SceneFile.Parse(file).Report.Diagnostics.First(found => found.Code == DiagnosticCodes.FieldUnknown);
        Assert.That((finding.Pointer, finding.Line), Is.EqualTo(("/gameObjects/0/nome", (int?)8)));
    }

    [TestCase(4, DiagnosticCodes.BufferSize)]
    [TestCase(9, DiagnosticCodes.BufferSize)]
    [TestCase(-1, DiagnosticCodes.BufferSize)]
    [TestCase(8, DiagnosticCodes.BufferSha256)]
    public void Validate_AnotherLength_IsAFinding(int length, string code)
    {
        byte[] file = Encoding.Latin1.GetBytes(Encoding.Latin1.GetString(Small).Replace("\"byteLength\": 5", $"\"byteLength\":{length,2}", StringComparison.Ordinal));
        Assert.That(Validated(file), Does.Contain(code));
    }

    [Test]
    public void Validate_ABufferThatNoChunkHolds_IsAFinding()
    {
        string text = Encoding.UTF8.GetString(Small, 20, BinaryPrimitives.ReadInt32LittleEndian(Small.AsSpan(12)));
        Assert.That(Validated(Encoding.UTF8.GetBytes(text)), Is.EqualTo([DiagnosticCodes.BufferMissing]));
        string twice = Encoding.Latin1.GetString(Bytes(SceneFile.Parse(Small).Document! with { ExtrasJson = "{\"" + new string('x', 200) + "\": 0}" }));
        int at = twice.IndexOf("    {\"byteLength\"", StringComparison.Ordinal);
        string buffer = twice.Substring(at, twice.IndexOf('\n', at) - at);
        string doubled = twice.Replace(buffer, buffer + ",\n" + buffer, StringComparison.Ordinal).Replace("\"" + new string('x', buffer.Length + 2), "\"", StringComparison.Ordinal);
        Assert.That(Validated(Encoding.Latin1.GetBytes(doubled)), Is.EqualTo([DiagnosticCodes.BufferMissing]));
    }

    [Test]
    public void Parse_AnyByteChanged_GivesAReportOrAScene()
    {
        Prop.ForAll(ArbMap.Default.ArbFor<int>(), seed =>
        {
            var random = new System.Random(seed);
            byte[] file = (byte[])Small.Clone();
            for (int fault = random.Next(1, 4); fault > 0; fault--)
                file[random.Next(random.Next(4) == 0 ? file.Length : 24)] = (byte)random.Next(256);
            if (random.Next(2) == 0)
                BinaryPrimitives.WriteInt32LittleEndian(file.AsSpan(8), file.Length);
            SceneReading reading = SceneFile.Parse(file);
            return reading.Document is null ? reading.Report.HasErrors : SceneValidator.Validate(reading.Document) is not null;
        }).Check(Config.QuickThrowOnFailure.WithMaxTest(5000));
    }

    private static byte[] WithChunk(byte[] file, string kind, int length)
    {
        byte[] longer = [.. file, (byte)length, 0, 0, 0, .. Encoding.ASCII.GetBytes(kind), .. new byte[length]];
        BinaryPrimitives.WriteInt32LittleEndian(longer.AsSpan(8), longer.Length);
        return longer;
    }

    private static byte[] Bytes(SceneDocument document)
    {
        using var stream = new MemoryStream();
        SceneFile.Save(document with { Container = SceneContainer.Binary }, stream);
        return stream.ToArray();
    }

    private static IEnumerable<string> Codes(SceneReading reading) => reading.Report.Diagnostics.Select(found => found.Code);

    private static IEnumerable<string> Validated(byte[] file)
    {
        SceneReading reading = SceneFile.Parse(file);
        Assert.That(reading.Document, Is.Not.Null, reading.Report.ToString());
        return SceneValidator.Validate(reading.Document!).Report.Diagnostics.Select(found => found.Code);
    }
}
