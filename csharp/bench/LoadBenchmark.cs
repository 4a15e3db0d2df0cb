using System;
using System.IO;
using System.Security.Cryptography;
using System.Text.Json;
using BenchmarkDotNet.Attributes;
using Kinefab.Document;
using Kinefab.Validation;

namespace Kinefab.Bench;

/// <summary>Load and validate a scene of 100,000 GameObjects beside a bare Utf8JsonReader token loop over the same bytes.</summary>
[MemoryDiagnoser]
public class LoadBenchmark
{
    private const int GameObjects = 100_000;

    private byte[] _text = [];
    private byte[] _buffer = [];
    private DirectoryInfo _folder = null!;
    private string _path = "";

    /// <summary>Size of the scene's text, bytes.</summary>
    internal static int Length => GeneratedScene.Write(GameObjects, out _).Length;

    /// <summary>What loading and validating it from memory allocates, and what of that the scene's model holds on to, bytes.</summary>
    internal static (long Allocated, long Kept) MeasureMemory()
    {
        byte[] text = GeneratedScene.Write(GameObjects, out byte[] buffer);
        Validate(SceneFile.Parse(text, _ => buffer));
        long before = GC.GetTotalMemory(forceFullCollection: true);
        long allocated = GC.GetAllocatedBytesForCurrentThread();
        SceneValidation validation = Validate(SceneFile.Parse(text, _ => buffer));
        allocated = GC.GetAllocatedBytesForCurrentThread() - allocated;
        long kept = GC.GetTotalMemory(forceFullCollection: true) - before;
        GC.KeepAlive(validation);
        GC.KeepAlive(text);
        return (allocated, kept);
    }

    /// <summary>Writes the scene.</summary>
    [GlobalSetup]
    public void Write()
    {
        _text = GeneratedScene.Write(GameObjects, out _buffer);
        _folder = Directory.CreateTempSubdirectory("kinefab-bench");
        _path = Path.Combine(_folder.FullName, "scene.kinefab");
        File.WriteAllBytes(_path, _text);
        File.WriteAllBytes(Path.Combine(_folder.FullName, "scene.bin"), _buffer);
    }

    /// <summary>Removes it.</summary>
    [GlobalCleanup]
    public void Remove() => _folder.Delete(recursive: true);

    /// <summary>All tokens, nothing done with them.</summary>
    [Benchmark(Baseline = true, Description = "Utf8JsonReader token loop")]
    public int Tokens()
    {
        int count = 0;
        var reader = new Utf8JsonReader(_text);
        while (reader.Read())
            count++;
        return count;
    }

    /// <summary>Without the file system.</summary>
    [Benchmark(Description = "load + validate, from memory")]
    public SceneValidation FromMemory() => Validate(SceneFile.Parse(_text, _ => _buffer));

    /// <summary>As users do.</summary>
    [Benchmark(Description = "load + validate, from a file")]
    public SceneValidation FromFile() => Validate(SceneFile.Load(_path));

    /// <summary>What a buffer of this size costs to check.</summary>
    [Benchmark(Description = "SHA-256 over as many bytes")]
    public byte[] Hash() => SHA256.HashData(_text);

    private static SceneValidation Validate(SceneReading reading)
    {
        SceneValidation validation = SceneValidator.Validate(reading.Document!);
        return validation.Report.Diagnostics.Count == 0 ? validation : throw new InvalidOperationException(validation.Report.Diagnostics[0].ToString());
    }
}
