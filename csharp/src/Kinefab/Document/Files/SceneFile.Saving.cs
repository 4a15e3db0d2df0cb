using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;

namespace Kinefab.Document;

/// <summary>Writes scene files; reading one that was written gives the same scene.</summary>
public static partial class SceneFile
{
    /// <summary>
    /// Writes NAME.kinefab, as text or binary as <see cref="SceneDocument.Container"/> says, and beside it the buffers whose data are there and
    /// that are not in it, each under a name made from the scene file's and its hash: whoever reads, and whenever the writer is
    /// killed, there is the old scene or the new one.  What an older save left of the scene's buffers is removed.
    /// </summary>
    /// <param name="document">What is written is not validated; fields at their defaults are left out.</param>
    /// <param name="path">In a folder that exists.</param>
    /// <exception cref="ArgumentException">Something is null where nothing may be (the message says where), a number is not finite, an <c>ExtrasJson</c> no
    /// object, a string no Unicode, or a binary file would have more than 4 GiB; nothing was written.</exception>
    /// <exception cref="DirectoryNotFoundException">There is no such folder; none is made.</exception>
    /// <exception cref="IOException">The file cannot be written; the old one stands as it was.</exception>
    /// <exception cref="UnauthorizedAccessException">As above.</exception>
    public static void Save(SceneDocument document, string path)
    {
        if (document is null)
            throw new ArgumentNullException(nameof(document));
        if (path is null)
            throw new ArgumentNullException(nameof(path));
        DemandNoNulls(document);
        string folder = Path.GetDirectoryName(Path.GetFullPath(path))!;
        string name = Path.GetFileName(path);
        document = document with { Buffers = SavedBuffers.Named(document.Buffers, name) };
        Content content = Of(document);
        if (!Directory.Exists(folder))
            throw new DirectoryNotFoundException($"There is no folder {folder} to write {name} into.");
        SavedBuffers.Write(content.Buffers, folder);
        WholeFile.Write(path, content.Write);
        SavedBuffers.RemoveOthers(content.Buffers, folder, name);
    }

    /// <summary>
    /// Writes a scene, as text or binary as <see cref="SceneDocument.Container"/> says; buffers that are not in it stay where they are, under the names that it
    /// states.
    /// </summary>
    /// <param name="document">What is written is not validated; fields at their defaults are left out.</param>
    /// <param name="stream">It stays open.</param>
    /// <exception cref="ArgumentException">Something is null where nothing may be (the message says where), a number is not finite, an <c>ExtrasJson</c> no
    /// object, a string no Unicode, a buffer of a text without name, or a binary file would have more than 4 GiB; nothing was written.</exception>
    /// <exception cref="IOException">The stream cannot be written.</exception>
    public static void Save(SceneDocument document, Stream stream)
    {
        if (document is null)
            throw new ArgumentNullException(nameof(document));
        if (stream is null)
            throw new ArgumentNullException(nameof(stream));
        DemandNoNulls(document);
        if (document.Container == SceneContainer.Text && document.Buffers.Any(buffer => buffer.Uri is null))
            throw new ArgumentException("A buffer has no uri: save the scene to a path, or as SceneContainer.Binary.", nameof(document));
        Of(document).Write(stream);
    }

    private static void DemandNoNulls(SceneDocument document) => document.FindNulls(
        (pointer, expected) => throw new ArgumentException($"{pointer}: there is null where {expected} belongs.", nameof(document)));

    private static Content Of(SceneDocument document)
    {
        if (document.Container == SceneContainer.Text)
            return new Content(SceneText.Of(document), null, document.Buffers, isBinary: false);
        (IReadOnlyList<SceneBuffer> buffers, ReadOnlyMemory<byte>? own) = OwnBuffer.Split(document.Buffers);
        return new Content(SceneText.Of(document with { Buffers = buffers }), own, buffers, isBinary: true);
    }

    /// <summary>Everything of a file, made before any of it is written.</summary>
    private sealed class Content
    {
        private readonly ReadOnlyMemory<byte> text;
        private readonly ReadOnlyMemory<byte>? own;
        private readonly bool isBinary;

        internal Content(ReadOnlyMemory<byte> text, ReadOnlyMemory<byte>? own, IReadOnlyList<SceneBuffer> buffers, bool isBinary)
        {
            this.text = text;
            this.own = own;
            this.isBinary = isBinary;
            Buffers = buffers;
            if (isBinary)
                BinaryFile.DemandRoom(text, own);
        }

        internal IReadOnlyList<SceneBuffer> Buffers { get; }

        internal void Write(Stream stream)
        {
            if (isBinary)
                BinaryFile.Write(stream, text, own);
            else
                stream.Write(text.Span);
        }
    }
}
