using System;
using System.Collections.Generic;
using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Triangles, clockwise from outside (Unity's winding), in the frame of the GameObject that uses them, metres.</summary>
public sealed record Mesh : DocumentObject
{
    internal static readonly FieldNames Fields = new(
        ["name", "vertexCount", "bounds", "positions", "indexFormat", "indices", "submeshes"],
        "normals", "uv", "extras");

    /// <summary>With nothing stated.</summary>
    public Mesh()
    {
    }

    internal Mesh(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "name":
                    Name = json.Text();
                    break;
                case "vertexCount":
                    VertexCount = json.Int();
                    break;
                case "bounds":
                    Bounds = new Bounds(ref json);
                    break;
                case "positions":
                    Positions = new Accessor(ref json);
                    break;
                case "normals":
                    Normals = new Accessor(ref json);
                    break;
                case "uv":
                    Uv = new Accessor(ref json);
                    break;
                case "indexFormat":
                    IndexFormat = json.Word(IndexFormatWords.Table);
                    break;
                case "indices":
                    Indices = new Accessor(ref json);
                    break;
                case "submeshes":
                    Submeshes = json.List(static (ref JsonCursor at) => new Submesh(ref at), least: 1);
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Mesh.name.</summary>
    public string Name { get; init; } = "";

    /// <summary>Number of vertices.</summary>
    public int VertexCount { get; init; }

    /// <summary>Box around the vertices.</summary>
    public Bounds Bounds { get; init; } = new();

    /// <summary>float32 x 3 a vertex, metres.</summary>
    public Accessor Positions { get; init; } = new();

    /// <summary>float32 x 3 a vertex, unit; null when there are none.</summary>
    public Accessor? Normals { get; init; }

    /// <summary>float32 x 2 a vertex; null when there are none.</summary>
    public Accessor? Uv { get; init; }

    /// <summary>Size of an index.</summary>
    public IndexFormat IndexFormat { get; init; }

    /// <summary>Three indices a triangle.</summary>
    public Accessor Indices { get; init; } = new();

    /// <summary>In the order of MeshRenderer.materials; they cover the indices without a gap.</summary>
    public IReadOnlyList<Submesh> Submeshes { get; init; } = Array.Empty<Submesh>();

    private protected override string Describe() => $"mesh \"{Name}\" of {VertexCount} vertices, {Submeshes.Count} submeshes";
}
