using System;

namespace Kinefab.Document;

/// <summary>A file of binary data beside the scene.</summary>
public sealed class SceneBuffer : DocumentObject
{
    /// <summary>File name relative to the scene's folder; never absolute, never with "..".</summary>
    public string Uri { get; init; } = "";

    /// <summary>Size of the file in bytes.</summary>
    public long ByteLength { get; init; }

    /// <summary>SHA-256 of the file's bytes, lower-case hexadecimal.</summary>
    public string Sha256 { get; init; } = "";

    /// <summary>The bytes; null when they could not be had.</summary>
    public ReadOnlyMemory<byte>? Data { get; init; }
}
