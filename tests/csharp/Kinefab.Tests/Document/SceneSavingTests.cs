using System;
using System.Collections;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Security.Cryptography;
using System.Text;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Tests.Conformance;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Document;

/// <summary>A scene that is written and read again is the same one, and its text is the exporter's.</summary>
public class SceneSavingTests
{
    private static readonly string Repository = Path.GetFullPath(Path.Combine(ConformanceCases.Folder, "..", ".."));

    private static readonly string[] Folders = ["fixtures", "csharp/examples/LeverTests"];

    private static IEnumerable<string> Exported => Folders
        .SelectMany(folder => Directory.GetFiles(Path.Combine(Repository, folder), "*.kinefab", SearchOption.AllDirectories))
        .Where(path => !path.Contains("/bin/", StringComparison.Ordinal))
        .Select(path => Path.GetRelativePath(Repository, path)).Order(StringComparer.Ordinal)
        .Append("tests/conformance/valid/look/signboard.kinefab");

    private static IEnumerable<string> Valid => ConformanceCases.All.Where(entry => entry.Kind == "scene" && entry.Path.StartsWith("valid/", StringComparison.Ordinal)).Select(entry => entry.FullPath);

    [TestCaseSource(nameof(Exported))]
    public void Save_WhatTheExporterWrote_IsTheSameBytes(string scene)
    {
        using var folder = new Folder();
        string source = Path.Combine(Repository, scene);
        string copy = folder.Of(Path.GetFileName(source));
        SceneFile.Save(SceneFile.Load(source).Document!, copy);
        Assert.That(File.ReadAllText(copy), Is.EqualTo(File.ReadAllText(source)));
        foreach (SceneBuffer buffer in SceneFile.Load(copy).Document!.Buffers)
            Assert.That(File.ReadAllBytes(folder.Of(buffer.Uri!)), Is.EqualTo(File.ReadAllBytes(Path.Combine(Path.GetDirectoryName(source)!, buffer.Uri!))));
    }

    [TestCaseSource(nameof(Valid))]
    public void Save_AnyScene_IsReadAsTheSame(string scene)
    {
        SceneDocument document = SceneFile.Load(scene).Document!;
        SceneReading again = SceneFile.Parse(Bytes(document));
        Assert.That(again.Report.Diagnostics, Is.Empty);
        Assert.That(Text(again.Document!), Is.EqualTo(Text(document)));
        Assert.That(Bytes(again.Document!), Is.EqualTo(Bytes(document)));
    }

    // The system names the temporary file beside the scene, which nobody asked for.
    [Test]
    public void Save_IntoAFolderThatIsNotThere_NamesItAndMakesNone()
    {
        using var folder = new Folder();
        string absent = folder.Of("absent");
        Assert.That(() => SceneFile.Save(new SceneDocument(), Path.Combine(absent, "a.kinefab")), Throws.InstanceOf<DirectoryNotFoundException>().With.Message.EqualTo($"There is no folder {absent} to write a.kinefab into."));
        Assert.That(Directory.Exists(absent), Is.False);
    }

    [TestCaseSource(typeof(SceneWithNull), nameof(SceneWithNull.All))]
    public void Save_WithANullInIt_SaysWhereAndWritesNothing(string place, string expected, SceneDocument document)
    {
        using var folder = new Folder();
        string path = folder.Of("scene.kinefab");
        string fault = $"{place}: there is null where {expected} belongs.";
        Assert.That(() => SceneFile.Save(document, path), Throws.ArgumentException.With.Message.StartsWith(fault));
        Assert.That(() => SceneFile.Save(document with { Container = SceneContainer.Binary }, path), Throws.ArgumentException.With.Message.StartsWith(fault));
        Assert.That(() => Bytes(document), Throws.ArgumentException.With.Message.StartsWith(fault));
        Assert.That(Directory.GetFileSystemEntries(folder.Path), Is.Empty);
    }

    [TestCaseSource(nameof(Exported))]
    public void Save_AsOneFile_IsReadAsTheSame(string scene)
    {
        using var folder = new Folder();
        SceneDocument document = SceneFile.Load(Path.Combine(Repository, scene)).Document!;
        string path = folder.Of(Path.GetFileName(scene));
        SceneFile.Save(document with { Container = SceneContainer.Binary }, path);
        Assert.That(Directory.GetFiles(folder.Path), Is.EqualTo([path]));
        ValidScene one = ValidScene.Load(path);
        Assert.That(one.Report.Diagnostics.Where(finding => finding.Severity != Kinefab.Diagnostics.Severity.Info), Is.Empty);
        Assert.That(one.Document.Container, Is.EqualTo(SceneContainer.Binary));
        Assert.That(one.Document.Buffers.Select(buffer => buffer.Data!.Value.ToArray()), Is.EqualTo(document.Buffers.Select(buffer => buffer.Data!.Value.ToArray())));

        // And back again, in place of the one file.
        SceneFile.Save(one.Document with { Container = SceneContainer.Text, Version = document.Version }, path);
        Assert.That(File.ReadAllText(path), Is.EqualTo(File.ReadAllText(Path.Combine(Repository, scene))));
    }

    [Test]
    public void Save_AsOneFile_IsBytesAsTheFormatSays()
    {
        var scene = new SceneDocument { Container = SceneContainer.Binary, Buffers = [new SceneBuffer { Data = new byte[] { 1, 2, 3, 4, 5 } }] };
        byte[] bytes = Bytes(scene);
        string text = Encoding.UTF8.GetString(Bytes(scene with { Container = SceneContainer.Text, Buffers = [], Version = "1.1" })).Replace(
            "  \"gameObjects\"", "  \"buffers\": [\n    {\"byteLength\": 5, \"sha256\": \"74f81fe167d99b4cb41d6d0ccda82278caee9f3e2f25d5e5a3936ff3dcec60d0\"}\n  ],\n  \"gameObjects\"", StringComparison.Ordinal);
        while (text.Length % 4 != 0)
            text += " ";
        using var expected = new MemoryStream();
        using var writer = new BinaryWriter(expected);
        writer.Write("KFAB"u8);
        writer.Write(1);
        writer.Write(12 + 8 + text.Length + 8 + 8);
        writer.Write(text.Length);
        writer.Write("JSON"u8);
        writer.Write(Encoding.UTF8.GetBytes(text));
        writer.Write(8);
        writer.Write("BIN\0"u8);
        writer.Write(new byte[] { 1, 2, 3, 4, 5, 0, 0, 0 });
        Assert.That(Encoding.Latin1.GetString(bytes), Is.EqualTo(Encoding.Latin1.GetString(expected.ToArray())));
    }

    /// <summary>A hundred textures, of which no decoder could make a picture: the file's bytes lie where they were read.</summary>
    [Test]
    public void Load_AHundredTextures_NeitherDecodesNorCopiesOne()
    {
        const int Size = 1 << 16;
        byte[] pixels = Enumerable.Range(0, 100 * Size).Select(i => (byte)(i * 31)).ToArray();
        for (int i = 0; i < 100; i++)
            new byte[] { 0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A }.CopyTo(pixels, i * Size);
        using var folder = new Folder();
        string path = folder.Of("a.kinefab");
        SceneFile.Save(
            new SceneDocument
            {
                Container = SceneContainer.Binary,
                Buffers = [new SceneBuffer { Data = pixels, ByteLength = pixels.Length, Sha256 = Convert.ToHexString(SHA256.HashData(pixels)).ToLowerInvariant() }],
                Images = Enumerable.Range(0, 100).Select(i => new Image { Name = $"{i}.png", MediaType = "image/png", Data = new Accessor { Offset = i * Size }, ByteLength = Size }).ToArray(),
                Materials = Enumerable.Range(0, 100).Select(i => new Material { Name = $"{i}", ColorTexture = new Texture { Image = i } }).ToArray(),
            },
            path);
        ValidScene.Load(path);
        long before = GC.GetAllocatedBytesForCurrentThread();
        ValidScene scene = ValidScene.Load(path);
        long allocated = GC.GetAllocatedBytesForCurrentThread() - before;
        Assert.That(allocated, Is.LessThan(1.5 * pixels.Length), "the file, once");
        Assert.That(scene.Document.BytesOf(scene.Document.Images[99]).Span.SequenceEqual(pixels.AsSpan(99 * Size)));
    }

    [Test]
    public void Save_SeveralBuffersAsOneFile_LeavesTheOthersBeside()
    {
        using var folder = new Folder();
        string path = folder.Of("a.kinefab");
        SceneFile.Save(new SceneDocument { Container = SceneContainer.Binary, Buffers = [new SceneBuffer { Data = new byte[4] }, new SceneBuffer { Data = new byte[8] }] }, path);
        Assert.That(Directory.GetFiles(folder.Path), Has.Length.EqualTo(2));
        Assert.That(ValidScene.Load(path).Document.Buffers.Select(buffer => buffer.Data!.Value.Length), Is.EqualTo([4, 8]));
    }

    [Test]
    public void Save_ABufferWithoutNameAsTextToAStream_Throws() =>
        Assert.That(() => Bytes(new SceneDocument { Buffers = [new SceneBuffer { Data = new byte[4] }] }), Throws.ArgumentException);

    [TestCase(0.1, "0.1")]
    [TestCase(-0.0, "0")]
    [TestCase(3.0, "3")]
    [TestCase(0.0001, "0.0001")]
    [TestCase(0.00001, "1e-05")]
    [TestCase(1.5e-7, "1.5e-07")]
    [TestCase(999999999999999, "999999999999999")]
    [TestCase(1e15, "1000000000000000.0")]
    [TestCase(-1234567890123456.5, "-1234567890123456.5")]
    [TestCase(9999999999999998, "9999999999999998.0")]
    [TestCase(1e16, "1e+16")]
    [TestCase(1.2345678901234567e300, "1.2345678901234567e+300")]
    [TestCase(1.0 / 3, "0.3333333333333333")]
    [TestCase(5e-324, "5e-324")]
    public void Save_ANumber_IsAsPythonWritesIt(double number, string text)
    {
        var scene = new SceneDocument { GameObjects = [new GameObject { Id = "a", Transform = new Transform { LocalPosition = new Vector3d(number, 1, 0) } }] };
        Assert.That(Encoding.UTF8.GetString(Bytes(scene)), Does.Contain($"\"localPosition\": [{text}, 1, 0]"));
    }

    [Test]
    public void Save_Strings_AreEscapedAsPythonDoes()
    {
        var scene = new SceneDocument { GameObjects = [new GameObject { Id = "ä\"\\/\b\f\n\r\t\u0001\u007f 日本 \U0001F600" }] };
        Assert.That(Encoding.UTF8.GetString(Bytes(scene)), Does.Contain("""{"id": "ä\"\\/\b\f\n\r\t\u0001""" + "\u007f 日本 \U0001F600\", \"name\": \"\"}"));
        Assert.That(SceneFile.Parse(Bytes(scene)).Document!.GameObjects[0].Id, Is.EqualTo(scene.GameObjects[0].Id));
    }

    [Test]
    public void Save_Extras_AreKeptInOneLine()
    {
        var scene = new SceneDocument { ExtrasJson = "{\"a\" :[1.50 ,{ }],\n \"b\\u00e4\": \"\\u0041\\n\", \"a\": null}" };
        Assert.That(Encoding.UTF8.GetString(Bytes(scene)), Does.EndWith("  \"extras\": {\"a\": [1.5, {}], \"bä\": \"A\\n\", \"a\": null}\n}\n"));
    }

    [Test]
    public void Save_AnArticulation_IsOfTheVersionThatHasIt()
    {
        var scene = new SceneDocument { GameObjects = [new GameObject { Id = "a", Components = [new ArticulationBody()] }] };
        Assert.That(SceneFile.Parse(Bytes(scene)).Document!.Version, Is.EqualTo("1.1"));
        Assert.That(SceneFile.Parse(Bytes(new SceneDocument { Version = "1.73" })).Document!.Version, Is.EqualTo("1.1"));
    }

    [Test]
    public void Save_WhatJsonCannotHold_ThrowsAndWritesNothing()
    {
        using var folder = new Folder();
        string path = folder.Of("a.kinefab");
        foreach (SceneDocument scene in new[]
        {
            new SceneDocument { Physics = new Physics { FixedTimestep = double.NaN } },
            new SceneDocument { ExtrasJson = "[]" },
            new SceneDocument { ExtrasJson = "{" },
            new SceneDocument { ExtrasJson = "{} {}" },
            new SceneDocument { ExtrasJson = "" },
            new SceneDocument { ExtrasJson = """{"a": [1e400]}""" },
            new SceneDocument { ExtrasJson = """{"a": "\ud800"}""" },
            new SceneDocument { Generator = new Generator { Name = "\ud800" } },
        })
            Assert.That(() => SceneFile.Save(scene, path), Throws.InstanceOf<ArgumentException>());
        Assert.That(Directory.GetFileSystemEntries(folder.Path), Is.Empty);
    }

    [Test]
    public void Save_AChangedBuffer_TakesTheOldOnesPlace()
    {
        using var folder = new Folder();
        string path = folder.Of("a.kinefab");
        File.WriteAllText(folder.Of("b.kinefab.0123456789abcdef.bin"), "another's");
        foreach (int length in new[] { 4, 8 })
        {
            SceneFile.Save(new SceneDocument { Buffers = [new SceneBuffer { Data = new byte[length] }] }, path);
            SceneBuffer read = SceneFile.Load(path).Document!.Buffers[0];
            Assert.That(read.Data!.Value.Length, Is.EqualTo(length));
            Assert.That(SceneValidator.Validate(SceneFile.Load(path).Document!).Report.HasErrors, Is.False);
            Assert.That(Directory.GetFiles(folder.Path), Has.Length.EqualTo(3), "scene, buffer and what is another's");
        }
    }

    // A hash that was stated for other bytes made a file that does not validate.
    [Test]
    public void Save_BytesThatTookTheOldOnesPlaceInABuffer_HaveTheirOwnHash([Values] SceneContainer container)
    {
        using var folder = new Folder();
        string path = folder.Of("a.kinefab");
        SceneFile.Save(new SceneDocument { Container = container, Buffers = [new SceneBuffer { Data = new byte[] { 1, 2, 3, 4 } }] }, path);
        SceneDocument read = SceneFile.Load(path).Document!;
        SceneFile.Save(read with { Buffers = [read.Buffers[0] with { Data = new byte[] { 5, 6, 7, 8 } }] }, path);
        Assert.That(ValidScene.Load(path).Document.Buffers[0].Data!.Value.ToArray(), Is.EqualTo(new byte[] { 5, 6, 7, 8 }));
    }

    [Test]
    public void Save_ThroughALink_WritesWhereItLeads()
    {
        using var folder = new Folder();
        File.WriteAllText(folder.Of("real.kinefab"), "");
        File.CreateSymbolicLink(folder.Of("link.kinefab"), "real.kinefab");
        SceneFile.Save(new SceneDocument(), folder.Of("link.kinefab"));
        Assert.That(File.ReadAllText(folder.Of("real.kinefab")), Does.StartWith("{\n  \"format\""));
        Assert.That(new FileInfo(folder.Of("link.kinefab")).LinkTarget, Is.EqualTo("real.kinefab"));
    }

    [Test]
    public void Save_WhereAFolderStands_LeavesEverythingAsItWas()
    {
        using var folder = new Folder();
        Directory.CreateDirectory(folder.Of("a.kinefab"));
        Assert.That(() => SceneFile.Save(new SceneDocument(), folder.Of("a.kinefab")), Throws.InstanceOf<IOException>().Or.InstanceOf<UnauthorizedAccessException>());
        Assert.That(Directory.GetFileSystemEntries(folder.Path), Has.Length.EqualTo(1));
    }

    private static byte[] Bytes(SceneDocument document)
    {
        using var stream = new MemoryStream();
        SceneFile.Save(document, stream);
        return stream.ToArray();
    }

    /// <summary>Every public property and what is in it, all the way down.</summary>
    private static string Text(object? value) => value switch
    {
        null => "null",
        string text => "\"" + text + "\"",
        DocumentObject noun => noun.GetType().Name + "(" + string.Join(", ", noun.GetType().GetProperties().Where(property => property.CanWrite && property.Name != "Data").Select(property => property.Name + " " + Text(property.GetValue(noun)))) + ")",
        IEnumerable list => "[" + string.Join(", ", list.Cast<object>().Select(Text)) + "]",
        double number => number.ToString("R"),
        _ => value.ToString()!,
    };

    private sealed class Folder : IDisposable
    {
        internal string Path { get; } = Directory.CreateTempSubdirectory().FullName;

        internal string Of(string file) => System.IO.Path.Combine(Path, file);

        public void Dispose() => Directory.Delete(Path, true);
    }
}
