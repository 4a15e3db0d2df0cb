using System;
using System.IO;
using System.Security;
using System.Threading;

namespace Kinefab.Document;

/// <summary>Whole files, but never more than a given size, whatever the file says of itself.</summary>
internal static class BoundedFile
{
    /// <summary>The longest array that .NET allows.</summary>
    private const long LongestArray = 0x7FFFFFC7;

    // Between two looks for a cancellation.
    private const int MostAtOnce = 1 << 26;

    /// <summary>The bytes; null when there are more than <paramref name="limit"/>, and then <paramref name="size"/> says at least how many.</summary>
    internal static byte[]? Read(string path, long limit, out long size, CancellationToken cancellation)
    {
        // A pipe or device has no length. It is not opened: that alone waits until somebody writes.
        size = 0;
        if (LengthOf(path) == 0)
            return Array.Empty<byte>();
        using var stream = new FileStream(path, FileMode.Open, FileAccess.Read, FileShare.Read, 1);
        if (!stream.CanSeek)
            throw new IOException("It is no regular file.");
        return Read(stream, limit, out size, cancellation);
    }

    private static long LengthOf(string path)
    {
        var file = new FileInfo(path);
#if NET6_0_OR_GREATER
        file = file.ResolveLinkTarget(returnFinalTarget: true) as FileInfo ?? file;
#endif
        return file.Exists ? file.Length : -1;
    }

    /// <summary>The bytes from where a stream stands to its end; null when there are more than <paramref name="limit"/>.</summary>
    internal static byte[]? Read(Stream stream, long limit, out long size, CancellationToken cancellation)
    {
        limit = Math.Min(limit, LongestArray);
        size = stream.CanSeek ? Math.Max(0, stream.Length - stream.Position) : 0;
        if (size > limit)
            return null;
#if NET5_0_OR_GREATER
        byte[] bytes = GC.AllocateUninitializedArray<byte>((int)size);
#else
        byte[] bytes = new byte[size];
#endif
        int count = 0;
        while (true)
        {
            // Devices and growing files hold more than their length says.
            if (count == bytes.Length)
            {
                int next = stream.ReadByte();
                if (next < 0)
                    break;
                if (count >= limit)
                {
                    size = count + 1L;
                    return null;
                }

                Array.Resize(ref bytes, (int)Math.Min(limit, Math.Max(4096L, count * 2L)));
                bytes[count++] = (byte)next;
            }

            cancellation.ThrowIfCancellationRequested();
            int read = stream.Read(bytes, count, Math.Min(bytes.Length - count, MostAtOnce));
            count += read;
            if (read == 0 && count < bytes.Length)
                break;
        }

        if (count < bytes.Length)
            Array.Resize(ref bytes, count);
        return bytes;
    }

    /// <summary>What the file system may throw at a path.</summary>
    internal static bool IsExpected(Exception fault) =>
        fault is IOException or UnauthorizedAccessException or ArgumentException or NotSupportedException or SecurityException;
}
