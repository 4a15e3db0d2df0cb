using System;
using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>A file of binary data beside the scene.</summary>
public sealed record SceneBuffer : DocumentObject
{
    internal static readonly FieldNames Fields = new(["uri", "byteLength", "sha256"], "extras");

    private ReadOnlyMemory<byte>? data;

    /// <summary>With nothing stated.</summary>
    public SceneBuffer()
    {
    }

    internal SceneBuffer(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "uri":
                    Uri = json.Text();
                    break;
                case "byteLength":
                    ByteLength = json.Integer();
                    break;
                case "sha256":
                    Sha256 = json.Text();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>File name relative to the scene's folder; never absolute, never with "..".</summary>
    public string Uri { get; init; } = "";

    /// <summary>Size of the file in bytes.</summary>
    public long ByteLength { get; init; }

    /// <summary>SHA-256 of the file's bytes, lower-case hexadecimal.</summary>
    public string Sha256 { get; init; } = "";

    /// <summary>The bytes; null when they could not be had.</summary>
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
