using System;
using System.Collections.Generic;

namespace Kinefab.Document;

/// <summary>Triangles, clockwise from outside (Unity's winding), in the frame of the GameObject that uses them, metres.</summary>
public sealed partial record Mesh : DocumentObject
{
    /// <summary>Mesh.name.</summary>
    [Field(Required = true)]
    public string Name { get; init; } = "";

    /// <summary>Number of vertices.</summary>
    [Field(Required = true)]
    public int VertexCount { get; init; }

    /// <summary>Box around the vertices.</summary>
    [Field(Required = true)]
    public Bounds Bounds { get; init; } = new();

    /// <summary>float32 x 3 a vertex, metres.</summary>
    [Field(Required = true)]
    public Accessor Positions { get; init; } = new();

    /// <summary>float32 x 3 a vertex, unit; null when there are none.</summary>
    public Accessor? Normals { get; init; }

    /// <summary>float32 x 2 a vertex; null when there are none.</summary>
    public Accessor? Uv { get; init; }

    /// <summary>float32 x 2 a vertex; null when there are none.</summary>
    [Since(1)]
    public Accessor? Uv2 { get; init; }

    /// <summary>float32 x 2 a vertex; null when there are none.</summary>
    [Since(1)]
    public Accessor? Uv3 { get; init; }

    /// <summary>float32 x 2 a vertex; null when there are none.</summary>
    [Since(1)]
    public Accessor? Uv4 { get; init; }

    /// <summary>float32 x 2 a vertex; null when there are none.</summary>
    [Since(1)]
    public Accessor? Uv5 { get; init; }

    /// <summary>float32 x 2 a vertex; null when there are none.</summary>
    [Since(1)]
    public Accessor? Uv6 { get; init; }

    /// <summary>float32 x 2 a vertex; null when there are none.</summary>
    [Since(1)]
    public Accessor? Uv7 { get; init; }

    /// <summary>float32 x 2 a vertex; null when there are none.</summary>
    [Since(1)]
    public Accessor? Uv8 { get; init; }

    /// <summary>float32 x 4 a vertex: unit, and the sense of the bitangent; null when there are none.</summary>
    [Since(1)]
    public Accessor? Tangents { get; init; }

    /// <summary>float32 x 4 a vertex, linear red, green, blue and alpha; null when there are none.</summary>
    [Since(1)]
    public Accessor? Colors { get; init; }

    /// <summary>Size of an index.</summary>
    [Field(Required = true)]
    public IndexFormat IndexFormat { get; init; }

    /// <summary>Three indices a triangle.</summary>
    [Field(Required = true)]
    public Accessor Indices { get; init; } = new();

    /// <summary>In the order of MeshRenderer.materials; they cover the indices without a gap.</summary>
    [Field(Required = true, Least = 1)]
    public IReadOnlyList<Submesh> Submeshes { get; init; } = Array.Empty<Submesh>();

    private protected override string Describe() => $"mesh \"{Name}\" of {VertexCount} vertices, {Submeshes.Count} submeshes";
}
