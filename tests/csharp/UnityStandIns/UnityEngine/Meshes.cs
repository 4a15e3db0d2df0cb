using System;
using System.Collections.Generic;
using UnityEngine.Rendering;

namespace UnityEngine
{
    public partial struct Bounds
    {
        public Bounds(Vector3 center, Vector3 size) => (this.center, extents) = (center, size * 0.5f);

        public Vector3 center { get; set; }

        public Vector3 extents { get; set; }

        public Vector3 size => extents * 2;

        public Vector3 min => center - extents;

        public Vector3 max => center + extents;

        public void Encapsulate(Bounds other)
        {
            Vector3 low = min, high = max, a = other.min, b = other.max;
            low = new Vector3(Math.Min(low.x, a.x), Math.Min(low.y, a.y), Math.Min(low.z, a.z));
            high = new Vector3(Math.Max(high.x, b.x), Math.Max(high.y, b.y), Math.Max(high.z, b.z));
            center = (low + high) * 0.5f;
            extents = (high - low) * 0.5f;
        }
    }

    public sealed partial class Mesh : Object
    {
        private readonly List<int[]> _submeshes = new List<int[]> { Array.Empty<int>() };
        private IndexFormat _indexFormat;
        private Vector3[] _vertices = Array.Empty<Vector3>();

        internal bool HasBounds { get; private set; }

        public Vector3[] vertices
        {
            get => Readable(_vertices);
            set => _vertices = value;
        }

        public int vertexCount => _vertices.Length;

        public Vector3[] normals { get; set; } = Array.Empty<Vector3>();

        public Vector4[] tangents { get; set; } = Array.Empty<Vector4>();

        public Color[] colors { get; set; } = Array.Empty<Color>();

        private readonly Vector2[][] _uvs = new Vector2[8][];

        public Vector2[] uv
        {
            get => _uvs[0] ?? Array.Empty<Vector2>();
            set => SetUVs(0, value);
        }

        public Vector2[] uv2
        {
            get => _uvs[1] ?? Array.Empty<Vector2>();
            set => SetUVs(1, value);
        }

        public void SetUVs(int channel, Vector2[] uvs) =>
            _uvs[channel] = uvs.Length == _vertices.Length ? uvs : throw new ArgumentException("Not as many as vertices.");

        public void GetUVs(int channel, List<Vector2> uvs)
        {
            uvs.Clear();
            uvs.AddRange(_uvs[channel] ?? Array.Empty<Vector2>());
        }

        public Bounds bounds { get; set; }

        public bool isReadable { get; private set; } = true;

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
            if (Array.Exists(triangles, i => i < 0 || i >= _vertices.Length) || triangles.Length % 3 != 0)
            {
                throw new ArgumentException("Not of these vertices.");
            }

            _submeshes[submesh] = triangles;
            RecalculateBounds();
        }

        public int[] GetTriangles(int submesh) => _submeshes[submesh];

        public void RecalculateNormals() => normals = new Vector3[_vertices.Length];

        public void RecalculateTangents() => tangents = uv.Length == 0 ? Array.Empty<Vector4>() : new Vector4[_vertices.Length];

        public void RecalculateBounds()
        {
            HasBounds = true;
            if (_vertices.Length == 0)
            {
                bounds = default;
                return;
            }

            var found = new Bounds(_vertices[0], Vector3.zero);
            foreach (Vector3 vertex in _vertices)
            {
                found.Encapsulate(new Bounds(vertex, Vector3.zero));
            }

            bounds = found;
        }

        public void UploadMeshData(bool markNoLongerReadable) => isReadable &= !markNoLongerReadable;

        private T Readable<T>(T value) => isReadable ? value : throw new InvalidOperationException("Not allowed to access vertices on mesh: it is not readable.");
    }

    public sealed class MeshFilter : Component
    {
        public Mesh sharedMesh { get; set; }
    }

    public class Renderer : Component
    {
        public bool enabled { get; set; } = true;

        public Material[] sharedMaterials { get; set; } = Array.Empty<Material>();

        public Material sharedMaterial
        {
            get => sharedMaterials.Length > 0 ? sharedMaterials[0] : null;
            set => sharedMaterials = new[] { value };
        }

        public Bounds bounds => gameObject.GetComponent<MeshFilter>()?.sharedMesh is Mesh mesh ? new Bounds(transform.TransformPoint(mesh.bounds.center), mesh.bounds.size) : default;
    }

    public sealed class MeshRenderer : Renderer
    {
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
