namespace Kinefab.Document;

/// <summary>A range of indices that is drawn with one material.</summary>
public sealed partial record Submesh : DocumentObject
{
    /// <summary>First index.</summary>
    [Field(Required = true)]
    public int IndexStart { get; init; }

    /// <summary>Number of indices, three a triangle.</summary>
    [Field(Required = true)]
    public int IndexCount { get; init; }
}
