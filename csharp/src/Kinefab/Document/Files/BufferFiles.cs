using System;
using System.IO;
using System.Linq;
using System.Threading;

namespace Kinefab.Document;

/// <summary>Reads the buffers of a scene from the folder of its file.</summary>
internal static class BufferFiles
{
    internal static void Attach(SceneDocument document, string folder, CancellationToken cancellation)
    {
        // A file that several buffers name is read, and held, once.
        foreach (IGrouping<string, SceneBuffer> file in document.Buffers.Where(buffer => buffer.Uri is string uri && BufferUri.IsSafe(uri)).GroupBy(buffer => buffer.Uri!, StringComparer.Ordinal))
        {
            try
            {
                byte[]? bytes = BoundedFile.Read(Path.Combine(folder, file.Key), Math.Max(0, file.Max(buffer => buffer.ByteLength)), out long size, cancellation);
                foreach (SceneBuffer buffer in file)
                {
                    long length = bytes?.Length ?? size;
                    buffer.Attach(length > buffer.ByteLength ? default(ReadOnlyMemory<byte>?) : bytes, null, length);
                }
            }
            catch (Exception fault) when (BoundedFile.IsExpected(fault))
            {
                // The message holds the full path, which differs from machine to machine.
                foreach (SceneBuffer buffer in file)
                    buffer.Attach(null, fault is FileNotFoundException or DirectoryNotFoundException ? "there is no such file" : "it cannot be opened");
            }
        }
    }
}
