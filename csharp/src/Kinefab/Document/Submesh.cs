namespace Kinefab.Document;

/// <summary>A range of indices that is drawn with one material.</summary>
public sealed class Submesh : DocumentObject
{
    /// <summary>First index.</summary>
    public int IndexStart { get; init; }

    /// <summary>Number of indices, three a triangle.</summary>
    public int IndexCount { get; init; }
}
