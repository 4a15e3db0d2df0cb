using Kinefab.Json;

namespace Kinefab.Document;

#pragma warning disable CA1720 // Unity's own names.

/// <summary>Size of a mesh's indices; values are Unity's.</summary>
public enum IndexFormat
{
    /// <summary>Two bytes.</summary>
    UInt16,

    /// <summary>Four bytes.</summary>
    UInt32,
}

/// <summary>The words of the scene file for <see cref="IndexFormat"/>.</summary>
internal static class IndexFormatWords
{
    internal static readonly Words<IndexFormat> Table = new(("uint16", IndexFormat.UInt16), ("uint32", IndexFormat.UInt32));
}
