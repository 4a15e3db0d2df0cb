namespace Kinefab.Document;

/// <summary>A run of values in a buffer, little-endian, tightly packed.</summary>
public sealed class Accessor : DocumentObject
{
    /// <summary>Index into <see cref="SceneDocument.Buffers"/>.</summary>
    public int Buffer { get; init; }

    /// <summary>Byte offset, a multiple of 4.</summary>
    public long Offset { get; init; }
}
