using System;
using System.Buffers.Binary;
using System.IO;
using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Document;

/// <summary>
/// One file for a scene and its buffer: "KFAB", the container's version, the file's length, then chunks, each with its length,
/// its kind and its data, padded to a multiple of 4; little-endian, as in GLB.
/// </summary>
internal readonly struct BinaryFile
{
    private const uint Version = 1;
    private const uint JsonChunk = 0x4E4F534A;
    private const uint BufferChunk = 0x004E4942;
    private const int HeaderLength = 12;
    private const int ChunkHeadLength = 8;

    private BinaryFile(ReadOnlyMemory<byte> text, ReadOnlyMemory<byte>? buffer)
    {
        Text = text;
        Buffer = buffer;
    }

    /// <summary>The JSON, with its padding.</summary>
    internal ReadOnlyMemory<byte> Text { get; }

    /// <summary>The buffer with its padding; null: there is none.</summary>
    internal ReadOnlyMemory<byte>? Buffer { get; }

    private static ReadOnlySpan<byte> Magic => "KFAB"u8;

    /// <summary>Told by its first bytes: no JSON begins so.</summary>
    internal static bool IsOne(ReadOnlySpan<byte> bytes) => bytes.StartsWith(Magic);

    /// <summary>The chunks, without a copy; false with the one finding that says why not.</summary>
    internal static bool TryOpen(ReadOnlyMemory<byte> bytes, Findings findings, out BinaryFile file)
    {
        file = default;
        if (bytes.Length < HeaderLength)
            return Fail(findings, "the file ends in its header");
        if (Number(bytes.Span, 4) is uint version and not Version)
        {
            findings.Add("", DiagnosticCodes.ContainerVersionUnsupported, ("version", Invariant.Text(version)));
            return false;
        }

        if (Number(bytes.Span, 8) is uint length && length != bytes.Length)
            return Fail(findings, $"the file has {Invariant.Text(bytes.Length)} bytes and says {Invariant.Text(length)}");
        ReadOnlyMemory<byte>? text = null;
        ReadOnlyMemory<byte>? buffer = null;
        for (ReadOnlyMemory<byte> rest = bytes.Slice(HeaderLength); rest.Length > 0;)
        {
            if (rest.Length < ChunkHeadLength)
                return Fail(findings, "the file ends in the head of a chunk");
            uint size = Number(rest.Span, 0);
            uint kind = Number(rest.Span, 4);
            rest = rest.Slice(ChunkHeadLength);
            if (size > rest.Length)
                return Fail(findings, $"a chunk of {Invariant.Text(size)} bytes has {Invariant.Text(rest.Length)} left");
            if (size % 4 != 0)
                return Fail(findings, $"a chunk has {Invariant.Text(size)} bytes, which is no multiple of 4");
            if (text is null && kind != JsonChunk)
                return Fail(findings, "its first chunk is not the JSON");
            ReadOnlyMemory<byte> data = rest.Slice(0, (int)size);
            rest = rest.Slice((int)size);
            if ((kind == JsonChunk && text is not null) || (kind == BufferChunk && buffer is not null))
                return Fail(findings, $"it has a second {(kind == JsonChunk ? "JSON" : "buffer")}");
            if (kind == JsonChunk)
                text = data;
            else if (kind == BufferChunk)
                buffer = data;
        }

        if (text is null)
            return Fail(findings, "it has no chunk");
        file = new BinaryFile(text.Value, buffer);
        return true;
    }

    /// <summary>Whether it can be written.</summary>
    /// <exception cref="ArgumentException">It would be longer than its header can say.</exception>
    internal static void DemandRoom(ReadOnlyMemory<byte> text, ReadOnlyMemory<byte>? buffer)
    {
        if (Length(text, buffer) is > uint.MaxValue and long length)
            throw new ArgumentException($"One file cannot hold {Invariant.Text(length)} bytes; save the scene as text.");
    }

    /// <summary>Writes a file; no buffer, no chunk for it.</summary>
    internal static void Write(Stream stream, ReadOnlyMemory<byte> text, ReadOnlyMemory<byte>? buffer)
    {
        Span<byte> header = stackalloc byte[HeaderLength];
        Magic.CopyTo(header);
        BinaryPrimitives.WriteUInt32LittleEndian(header.Slice(4), Version);
        BinaryPrimitives.WriteUInt32LittleEndian(header.Slice(8), (uint)Length(text, buffer));
        stream.Write(header);
        WriteChunk(stream, JsonChunk, text, (byte)' ');
        if (buffer is { } data)
            WriteChunk(stream, BufferChunk, data, 0);
    }

    private static void WriteChunk(Stream stream, uint kind, ReadOnlyMemory<byte> data, byte filler)
    {
        Span<byte> head = stackalloc byte[ChunkHeadLength];
        BinaryPrimitives.WriteUInt32LittleEndian(head, (uint)Padded(data.Length));
        BinaryPrimitives.WriteUInt32LittleEndian(head.Slice(4), kind);
        stream.Write(head);
        stream.Write(data.Span);
        for (long i = data.Length; i < Padded(data.Length); i++)
            stream.WriteByte(filler);
    }

    private static long Length(ReadOnlyMemory<byte> text, ReadOnlyMemory<byte>? buffer) =>
        HeaderLength + ChunkHeadLength + Padded(text.Length) + (buffer is { } own ? ChunkHeadLength + Padded(own.Length) : 0);

    private static long Padded(long length) => (length + 3) / 4 * 4;

    private static uint Number(ReadOnlySpan<byte> bytes, int at) => BinaryPrimitives.ReadUInt32LittleEndian(bytes.Slice(at));

    private static bool Fail(Findings findings, string detail)
    {
        findings.Add("", DiagnosticCodes.ContainerInvalid, ("detail", detail));
        return false;
    }
}
