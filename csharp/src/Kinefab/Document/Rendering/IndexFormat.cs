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
