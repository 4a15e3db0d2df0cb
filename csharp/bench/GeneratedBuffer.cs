using System;
using System.Runtime.InteropServices;
using System.Security.Cryptography;

namespace Kinefab.Bench;

/// <summary>The one mesh of a generated scene, and how the scene describes it.</summary>
internal static class GeneratedBuffer
{
    internal static byte[] Tetrahedron()
    {
        float[] positions = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 };
        ushort[] indices = { 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3 };
        byte[] bytes = new byte[positions.Length * 4 + indices.Length * 2];
        MemoryMarshal.AsBytes<float>(positions).CopyTo(bytes);
        MemoryMarshal.AsBytes<ushort>(indices).CopyTo(bytes.AsSpan(positions.Length * 4));
        return bytes;
    }

    /// <summary>The scene's buffers, meshes and materials.</summary>
    internal static string Describe(byte[] buffer) => $$"""
          "buffers": [{"uri": "scene.bin", "byteLength": {{buffer.Length}}, "sha256": "{{Convert.ToHexStringLower(SHA256.HashData(buffer))}}"}],
          "meshes": [{"name": "link", "vertexCount": 4, "bounds": {"center": [0.5, 0.5, 0.5], "extents": [0.5, 0.5, 0.5]},
            "positions": {"buffer": 0, "offset": 0}, "indexFormat": "uint16", "indices": {"buffer": 0, "offset": 48},
            "submeshes": [{"indexStart": 0, "indexCount": 12}]}],
          "materials": [{"name": "Steel", "color": [0.7, 0.7, 0.72, 1], "metallic": 1, "smoothness": 0.6}],

        """;
}
