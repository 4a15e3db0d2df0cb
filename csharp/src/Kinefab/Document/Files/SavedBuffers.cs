using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;

namespace Kinefab.Document;

/// <summary>The buffers of a scene as files beside it, named after it and what is in them, so that a new one never takes an old one's place.</summary>
internal static class SavedBuffers
{
    // Hexadecimal digits of the hash in a file's name.
    private const int Digits = 16;

    /// <summary>The buffers as a scene of this file name holds them; those without data stay as they are.</summary>
    internal static IReadOnlyList<SceneBuffer> Named(IReadOnlyList<SceneBuffer> buffers, string name) =>
        buffers.Select(buffer => buffer.Data is null ? buffer : Named(buffer.Stated(), name)).ToArray();

    /// <summary>Writes each whose data are there.</summary>
    internal static void Write(IEnumerable<SceneBuffer> buffers, string folder)
    {
        foreach (SceneBuffer buffer in buffers)
        {
            if (buffer is { Data: { } data, Uri: string uri })
                WholeFile.Write(Path.Combine(folder, uri), file => file.Write(data.Span));
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

    private static SceneBuffer Named(SceneBuffer buffer, string name) => buffer with { Uri = $"{name}.{buffer.Sha256.Substring(0, Math.Min(Digits, buffer.Sha256.Length))}.bin" };
}
