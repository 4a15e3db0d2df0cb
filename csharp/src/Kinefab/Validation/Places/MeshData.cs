using System;
using System.Runtime.InteropServices;
using Kinefab.Document;

namespace Kinefab.Validation;

/// <summary>The numbers of a mesh, seen in the buffer without a copy.  Little-endian machines only, as all that Unity runs on are.</summary>
public readonly ref struct MeshData
{
    /// <summary>Most sets of texture coordinates that a mesh has, as in Unity.</summary>
    internal const int UvSets = 8;

    private readonly SceneDocument document;

    internal MeshData(SceneDocument document, Mesh mesh)
    {
        this.document = document;
        Mesh = mesh;
    }

    /// <summary>The mesh.</summary>
    public Mesh Mesh { get; }

    /// <summary>x y z for each vertex, metres.</summary>
    public ReadOnlySpan<float> Positions => Floats(Mesh.Positions, 3);

    /// <summary>x y z for each vertex, unit; empty when there are none.</summary>
    public ReadOnlySpan<float> Normals => Floats(Mesh.Normals, 3);

    /// <summary>u v for each vertex; empty when there are none.</summary>
    public ReadOnlySpan<float> Uv => Floats(Mesh.Uv, 2);

    /// <summary>x y z and the sense of the bitangent, 1 or -1, for each vertex; empty when there are none.</summary>
    public ReadOnlySpan<float> Tangents => Floats(Mesh.Tangents, 4);

    /// <summary>Linear red, green, blue and alpha for each vertex; empty when there are none.</summary>
    public ReadOnlySpan<float> Colors => Floats(Mesh.Colors, 4);

    /// <summary>Three for each triangle; empty unless the format is UInt16.</summary>
    public ReadOnlySpan<ushort> Indices16 => Mesh.IndexFormat == IndexFormat.UInt16 ? MemoryMarshal.Cast<byte, ushort>(IndexSpan) : default;

    /// <summary>Three for each triangle; empty unless the format is UInt32.</summary>
    public ReadOnlySpan<uint> Indices32 => Mesh.IndexFormat == IndexFormat.UInt32 ? MemoryMarshal.Cast<byte, uint>(IndexSpan) : default;

    private ReadOnlySpan<byte> IndexSpan => Bytes(document, Mesh.Indices, IndexBytes(Mesh));

    /// <summary>u v for each vertex in one set of texture coordinates; empty when there are none.</summary>
    /// <param name="set">0 for <see cref="Mesh.Uv"/>, 1 for <see cref="Mesh.Uv2"/>, as <see cref="Texture.UvSet"/> counts.</param>
    /// <returns>Two numbers for each vertex.</returns>
    public ReadOnlySpan<float> UvOf(int set) => Floats(UvAccessor(Mesh, set), 2);

    internal static Accessor? UvAccessor(Mesh mesh, int set) => set switch
    {
        0 => mesh.Uv,
        1 => mesh.Uv2,
        2 => mesh.Uv3,
        3 => mesh.Uv4,
        4 => mesh.Uv5,
        5 => mesh.Uv6,
        6 => mesh.Uv7,
        7 => mesh.Uv8,
        _ => null,
    };

    internal static long IndexBytes(Mesh mesh)
    {
        long count = 0;
        for (int i = 0; i < mesh.Submeshes.Count; i++)
            count += Math.Max(0, mesh.Submeshes[i].IndexCount);
        return count * (mesh.IndexFormat == IndexFormat.UInt16 ? 2 : 4);
    }

    internal static ReadOnlySpan<byte> Bytes(SceneDocument document, Accessor accessor, long count) =>
        document.Buffers[accessor.Buffer].Data!.Value.Span.Slice((int)accessor.Offset, (int)count);

    private ReadOnlySpan<float> Floats(Accessor? accessor, int width) =>
        accessor is null ? default : MemoryMarshal.Cast<byte, float>(Bytes(document, accessor, (long)Mesh.VertexCount * width * 4));
}
