using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>MeshCollider.</summary>
public sealed record MeshCollider : Collider
{
    internal static readonly FieldNames Fields = new(
        ["type", "mesh"],
        [
            .. ColliderFields,
            "convex", "extras",
        ]);

    /// <summary>Unity's defaults.</summary>
    public MeshCollider()
    {
    }

    internal MeshCollider(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "mesh":
                    Mesh = json.Int();
                    break;
                case "convex":
                    Convex = json.Boolean();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
                default:
                    ReadColliderField(ref json, fields.Name);
                    break;
            }
        }
    }

    /// <summary>Index into <see cref="SceneDocument.Meshes"/>.</summary>
    public int Mesh { get; init; }

    /// <summary>Unity takes the mesh's convex hull; needed on a Rigidbody that is not kinematic.</summary>
    public bool Convex { get; init; }

    private protected override string Describe() => $"MeshCollider of mesh {Mesh}{(Convex ? ", convex" : "")}{(IsTrigger ? ", trigger" : "")}";
}
