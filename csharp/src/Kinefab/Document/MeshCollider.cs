namespace Kinefab.Document;

/// <summary>MeshCollider.</summary>
public sealed class MeshCollider : Collider
{
    /// <summary>Index into <see cref="SceneDocument.Meshes"/>.</summary>
    public int Mesh { get; init; }

    /// <summary>Unity takes the mesh's convex hull; needed on a Rigidbody that is not kinematic.</summary>
    public bool Convex { get; init; }
}
