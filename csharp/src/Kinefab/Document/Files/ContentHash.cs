using System;
using System.Buffers;
using System.Globalization;
using System.Linq;
using System.Security.Cryptography;
using System.Threading;

namespace Kinefab.Document;

/// <summary>SHA-256 of buffers, by which a scene knows the ones it was written with.</summary>
internal static class ContentHash
{
    // Bytes hashed between two looks for a cancellation.
    private const int MostAtOnce = 1 << 20;

    /// <summary>64 lower-case hexadecimal digits.</summary>
    internal static string Of(ReadOnlySpan<byte> bytes, CancellationToken cancellation = default)
    {
        using var algorithm = IncrementalHash.CreateHash(HashAlgorithmName.SHA256);

        // netstandard2.1 hashes arrays alone.
        byte[] part = ArrayPool<byte>.Shared.Rent(MostAtOnce);
        while (bytes.Length > 0)
        {
            cancellation.ThrowIfCancellationRequested();
            int length = Math.Min(bytes.Length, part.Length);
            bytes.Slice(0, length).CopyTo(part);
            algorithm.AppendData(part, 0, length);
            bytes = bytes.Slice(length);
        }

        ArrayPool<byte>.Shared.Return(part);
        return string.Concat(algorithm.GetHashAndReset().Select(value => value.ToString("x2", CultureInfo.InvariantCulture)));
    }
}
