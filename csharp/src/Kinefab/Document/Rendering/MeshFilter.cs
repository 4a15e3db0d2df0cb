using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>MeshFilter: which mesh a GameObject shows.</summary>
public sealed record MeshFilter : Component
{
    internal static readonly FieldNames Fields = new(["type", "mesh"], "extras");

    /// <summary>Unity's defaults.</summary>
    public MeshFilter()
    {
    }

    internal MeshFilter(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "mesh":
                    Mesh = json.Int();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Index into <see cref="SceneDocument.Meshes"/>.</summary>
    public int Mesh { get; init; }

    private protected override string Describe() => $"MeshFilter of mesh {Mesh}";
}
