using System;
using System.Collections.Generic;
using System.IO;

namespace Kinefab.Document;

/// <summary>Writes scene files; reading one that was written gives the same scene.</summary>
public static partial class SceneFile
{
    /// <summary>
    /// Writes NAME.kinefab and, beside it, the buffers whose data are there, each under a name made from the scene file's and its hash:
    /// whoever reads, and whenever the writer is killed, there is the old scene or the new one.  What an older save left of the
    /// scene's buffers is removed.
    /// </summary>
    /// <param name="document">What is written is not validated; fields at their defaults are left out.</param>
    /// <param name="path">In a folder that exists.</param>
    /// <exception cref="ArgumentException">A number is not finite, an <c>ExtrasJson</c> no object, or a string no Unicode; nothing was written.</exception>
    /// <exception cref="IOException">The file cannot be written; the old one stands as it was.</exception>
    /// <exception cref="UnauthorizedAccessException">As above.</exception>
    public static void Save(SceneDocument document, string path)
    {
        if (document is null)
            throw new ArgumentNullException(nameof(document));
        if (path is null)
            throw new ArgumentNullException(nameof(path));
        string folder = Path.GetDirectoryName(Path.GetFullPath(path))!;
        string name = Path.GetFileName(path);
        IReadOnlyList<SceneBuffer> buffers = SavedBuffers.Named(document.Buffers, name);
        ReadOnlyMemory<byte> text = SceneText.Of(document with { Buffers = buffers });
        SavedBuffers.Write(buffers, folder);
        WholeFile.Write(path, file => file.Write(text.Span));
        SavedBuffers.RemoveOthers(buffers, folder, name);
    }

    /// <summary>Writes the text of a scene; its buffers stay where they are, under the names that it states.</summary>
    /// <param name="document">What is written is not validated; fields at their defaults are left out.</param>
    /// <param name="stream">It stays open.</param>
    /// <exception cref="ArgumentException">A number is not finite, an <c>ExtrasJson</c> no object, or a string no Unicode; nothing was written.</exception>
    /// <exception cref="IOException">The stream cannot be written.</exception>
    public static void Save(SceneDocument document, Stream stream)
    {
        if (document is null)
            throw new ArgumentNullException(nameof(document));
        if (stream is null)
            throw new ArgumentNullException(nameof(stream));
        stream.Write(SceneText.Of(document).Span);
    }
}
