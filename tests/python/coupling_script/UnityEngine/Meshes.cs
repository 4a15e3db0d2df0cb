using System;
using System.Collections.Generic;
using UnityEngine.Rendering;

namespace UnityEngine
{
    public sealed class Mesh : Object
    {
        private readonly List<int[]> _submeshes = new List<int[]> { Array.Empty<int>() };
        private IndexFormat _indexFormat;

        public Vector3[] vertices { get; set; } = Array.Empty<Vector3>();

        public Vector3[] normals { get; set; } = Array.Empty<Vector3>();

        public Vector2[] uv { get; set; } = Array.Empty<Vector2>();

        public IndexFormat indexFormat
        {
            get => _indexFormat;
            set => _indexFormat = _submeshes.TrueForAll(s => s.Length == 0) ? value : throw new InvalidOperationException("Unity clears the indices.");
        }

        public int subMeshCount
        {
            get => _submeshes.Count;
            set
            {
                while (_submeshes.Count < value)
                {
                    _submeshes.Add(Array.Empty<int>());
                }

                _submeshes.RemoveRange(value, _submeshes.Count - value);
            }
        }

        public void SetTriangles(int[] triangles, int submesh)
        {
            if (Array.Exists(triangles, i => i < 0 || i >= vertices.Length) || triangles.Length % 3 != 0)
            {
                throw new ArgumentException("Not of these vertices.");
            }

            _submeshes[submesh] = triangles;
        }

        public int[] GetTriangles(int submesh) => _submeshes[submesh];

        public void RecalculateNormals() => normals = new Vector3[vertices.Length];
    }

    public sealed class MeshFilter : Component
    {
        public Mesh sharedMesh { get; set; }
    }

    public class Renderer : Component
    {
        public bool enabled { get; set; } = true;

        public Material[] sharedMaterials { get; set; } = Array.Empty<Material>();
    }

    public sealed class MeshRenderer : Renderer
    {
    }

    public sealed class Shader : Object
    {
        internal string[] Properties;

        public static Shader Find(string name) =>
            name == "Standard" ? new Shader { name = name, Properties = new[] { "_Metallic", "_Glossiness" } } : null;
    }

    public sealed class Material : Object
    {
        private readonly Dictionary<string, float> _floats = new Dictionary<string, float>();
        private readonly Shader _shader;

        public Material(Shader shader) => _shader = shader ?? throw new ArgumentNullException(nameof(shader));

        public Material(Material source)
            : this(source._shader)
        {
        }

        public Color color { get; set; }

        public bool HasProperty(string name) => Array.IndexOf(_shader.Properties, name) >= 0;

        public void SetFloat(string name, float value) => _floats[name] = value;

        public float GetFloat(string name) => _floats[name];
    }
}

namespace UnityEngine.Rendering
{
    public enum IndexFormat
    {
        UInt16 = 0,
        UInt32 = 1,
    }
}
