namespace Kinefab.Document;

/// <summary>MeshCollider.</summary>
public sealed partial record MeshCollider : Collider
{
    /// <summary>Index into <see cref="SceneDocument.Meshes"/>.</summary>
    [Field(Required = true)]
    public int Mesh { get; init; }

    /// <summary>Unity takes the mesh's convex hull; needed on a Rigidbody that is not kinematic.</summary>
    public bool Convex { get; init; }

    private protected override string Describe() => $"MeshCollider of mesh {Mesh}{(Convex ? ", convex" : "")}{(IsTrigger ? ", trigger" : "")}";
}
