namespace Kinefab.Document;

/// <summary>A run of values in a buffer, little-endian, tightly packed.</summary>
public sealed partial record Accessor : DocumentObject
{
    /// <summary>Index into <see cref="SceneDocument.Buffers"/>.</summary>
    [Field(Required = true)]
    public int Buffer { get; init; }

    /// <summary>Byte offset, a multiple of 4.</summary>
    [Field(Required = true)]
    public long Offset { get; init; }
}
