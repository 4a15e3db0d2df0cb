namespace Kinefab.Document;

/// <summary>MeshFilter: which mesh a GameObject shows.</summary>
public sealed class MeshFilter : Component
{
    /// <summary>Index into <see cref="SceneDocument.Meshes"/>.</summary>
    public int Mesh { get; init; }
}
