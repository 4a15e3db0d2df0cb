using System;
using System.Buffers;
using System.Globalization;
using System.Linq;
using System.Security.Cryptography;
using System.Threading;

namespace Kinefab.Document;

/// <summary>Binary data: a file beside the scene, or a part of the scene's own.</summary>
public sealed partial record SceneBuffer : DocumentObject
{
    // Bytes hashed between two looks for a cancellation.
    private const int MostHashedAtOnce = 1 << 20;

    private ReadOnlyMemory<byte>? data;

    // By a program: whatever hash is stated may be that of other bytes.
    private bool isGiven;

    /// <summary>File name relative to the scene's folder; never absolute, never with "..". Null: the buffer lies in the scene's own file.</summary>
    public string? Uri { get; init; }

    /// <summary>Size of the file in bytes.</summary>
    [Field(Required = true)]
    public long ByteLength { get; init; }

    /// <summary>SHA-256 of the file's bytes, lower-case hexadecimal.</summary>
    [Field(Required = true)]
    public string Sha256 { get; init; } = "";

    /// <summary>The bytes; null when they could not be had.</summary>
    [Field(InFile = false)]
    public ReadOnlyMemory<byte>? Data
    {
        get => data;
        init
        {
            data = value;
            isGiven = true;
        }
    }

    /// <summary>Why there is no <see cref="Data"/>; null: nobody looked for it.</summary>
    internal string? Fault { get; private set; }

    /// <summary>Size of what was found instead of <see cref="Data"/>, or -1.</summary>
    internal long FoundLength { get; private set; } = -1;

    internal void Attach(ReadOnlyMemory<byte>? bytes, string? fault = null, long foundLength = -1)
    {
        data = bytes;
        isGiven = false;
        Fault = fault;
        FoundLength = foundLength;
    }

    /// <summary>With the size and hash of its data; of data that were read the hash stays that which was stated.</summary>
    internal SceneBuffer Stated() => this with { ByteLength = data!.Value.Length, Sha256 = Sha256.Length > 0 && !isGiven ? Sha256 : Hash(data.Value.Span) };

    /// <summary>SHA-256, 64 lower-case hexadecimal digits.</summary>
    internal static string Hash(ReadOnlySpan<byte> bytes, CancellationToken cancellation = default)
    {
        using var algorithm = IncrementalHash.CreateHash(HashAlgorithmName.SHA256);

        // netstandard2.1 hashes arrays alone.
        byte[] part = ArrayPool<byte>.Shared.Rent(MostHashedAtOnce);
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

    private protected override string Describe() => $"buffer {Uri ?? "in the scene's file"} of {ByteLength} bytes{(Data is null ? ", not loaded" : "")}";
}
