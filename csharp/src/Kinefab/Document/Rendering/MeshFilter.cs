namespace Kinefab.Document;

/// <summary>MeshFilter: which mesh a GameObject shows.</summary>
public sealed partial record MeshFilter : Component
{
    /// <summary>Index into <see cref="SceneDocument.Meshes"/>.</summary>
    [Field(Required = true)]
    public int Mesh { get; init; }

    private protected override string Describe() => $"MeshFilter of mesh {Mesh}";
}
