using System;

namespace Kinefab.Document;

/// <summary>A file of binary data beside the scene.</summary>
public sealed partial record SceneBuffer : DocumentObject
{
    private ReadOnlyMemory<byte>? data;

    /// <summary>File name relative to the scene's folder; never absolute, never with "..".</summary>
    [Field(Required = true)]
    public string Uri { get; init; } = "";

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
        init => data = value;
    }

    /// <summary>Why there is no <see cref="Data"/>; null: nobody looked for it.</summary>
    internal string? Fault { get; private set; }

    /// <summary>Size of what was found instead of <see cref="Data"/>, or -1.</summary>
    internal long FoundLength { get; private set; } = -1;

    internal void Attach(ReadOnlyMemory<byte>? bytes, string? fault = null, long foundLength = -1)
    {
        data = bytes;
        Fault = fault;
        FoundLength = foundLength;
    }

    private protected override string Describe() => $"buffer {Uri} of {ByteLength} bytes{(Data is null ? ", not loaded" : "")}";
}
