using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Security.Cryptography;
using System.Text.RegularExpressions;

namespace Kinefab.Document;

/// <summary>The buffers of a scene as files beside it, named after it and what is in them, so that a new one never takes an old one's place.</summary>
internal static class SavedBuffers
{
    // Hexadecimal digits of the hash in a file's name.
    private const int Digits = 16;

    /// <summary>The buffers as a scene of this file name holds them; those without data stay as they are, and what is stated of the others' size and hash is kept.</summary>
    internal static IReadOnlyList<SceneBuffer> Named(IReadOnlyList<SceneBuffer> buffers, string name) =>
        buffers.Select(buffer => buffer.Data is ReadOnlyMemory<byte> data ? Stated(buffer, data, name) : buffer).ToArray();

    /// <summary>Writes each that is not there yet.</summary>
    internal static void Write(IEnumerable<SceneBuffer> buffers, string folder)
    {
        foreach (SceneBuffer buffer in buffers)
        {
            if (buffer.Data is ReadOnlyMemory<byte> data)
                WholeFile.Write(Path.Combine(folder, buffer.Uri), file => file.Write(data.Span));
        }
    }

    /// <summary>Removes those of the same scene file that it names no more.</summary>
    internal static void RemoveOthers(IReadOnlyList<SceneBuffer> kept, string folder, string name)
    {
        var ours = new Regex($"^{Regex.Escape(name)}\\.[0-9a-f]{{{Digits}}}\\.bin$", RegexOptions.CultureInvariant);
        foreach (string path in Directory.GetFiles(folder, "*.bin"))
        {
            string file = Path.GetFileName(path);
            if (ours.IsMatch(file) && !kept.Any(buffer => buffer.Uri == file))
                File.Delete(path);
        }
    }

    private static SceneBuffer Stated(SceneBuffer buffer, ReadOnlyMemory<byte> data, string name)
    {
        string hash = buffer.Sha256.Length > 0 ? buffer.Sha256 : Sha256(data.Span);
        return buffer with
        {
            Uri = $"{name}.{hash.Substring(0, Math.Min(Digits, hash.Length))}.bin",
            ByteLength = data.Length,
            Sha256 = hash,
        };
    }

    private static string Sha256(ReadOnlySpan<byte> data)
    {
        Span<byte> hash = stackalloc byte[32];
        using var sha = SHA256.Create();
        sha.TryComputeHash(data, hash, out _);
        return string.Concat(hash.ToArray().Select(b => b.ToString("x2", CultureInfo.InvariantCulture)));
    }
}
