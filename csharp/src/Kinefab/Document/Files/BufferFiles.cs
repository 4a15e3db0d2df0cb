using System;
using System.IO;
using System.Threading;

namespace Kinefab.Document;

/// <summary>Reads the buffers of a scene from the folder of its file.</summary>
internal static class BufferFiles
{
    internal static void Attach(SceneDocument document, string folder, CancellationToken cancellation)
    {
        foreach (SceneBuffer buffer in document.Buffers)
        {
            if (BufferUri.IsSafe(buffer.Uri))
                Attach(buffer, Path.Combine(folder, buffer.Uri), cancellation);
        }
    }

    private static void Attach(SceneBuffer buffer, string path, CancellationToken cancellation)
    {
        try
        {
            byte[]? bytes = BoundedFile.Read(path, Math.Max(0, buffer.ByteLength), out long size, cancellation);
            buffer.Attach(bytes, null, size);
        }
        catch (Exception fault) when (BoundedFile.IsExpected(fault))
        {
            // The message holds the full path, which differs from machine to machine.
            buffer.Attach(null, fault is FileNotFoundException or DirectoryNotFoundException ? "there is no such file" : "it cannot be opened");
        }
    }
}
