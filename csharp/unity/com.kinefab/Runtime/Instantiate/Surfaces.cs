using System;
using Kinefab.Validation;
using UnityEngine;
using UnityEngine.Rendering;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>Meshes and materials of a scene, each made when it is first asked for and shared by all that show it.</summary>
    internal sealed class Surfaces
    {
        private readonly ValidScene scene;
        private readonly Material template;
        private readonly Mesh[] meshes;
        private readonly Material[] materials;

        internal Surfaces(ValidScene scene, Material template)
        {
            this.scene = scene;
            this.template = template;
            meshes = new Mesh[scene.Document.Meshes.Count];
            materials = new Material[scene.Document.Materials.Count];
        }

        internal Mesh Mesh(int index) => meshes[index] ??= Make(scene.Mesh(index));

        internal Material Material(int index) => materials[index] ??= Make(scene.Document.Materials[index]);

        private static Mesh Make(MeshData data)
        {
            Doc.Mesh from = data.Mesh;

            // The size of an index first: 65,536 vertices and more do not fit the smaller one.
            var mesh = new Mesh { name = from.Name, indexFormat = (IndexFormat)from.IndexFormat, vertices = Vectors(data.Positions) };
            mesh.subMeshCount = from.Submeshes.Count;
            for (int i = 0; i < from.Submeshes.Count; i++)
            {
                mesh.SetTriangles(Indices(data, from.Submeshes[i]), i);
            }

            if (!data.Uv.IsEmpty)
            {
                mesh.uv = Pairs(data.Uv);
            }

            if (data.Normals.IsEmpty)
            {
                mesh.RecalculateNormals();
            }
            else
            {
                mesh.normals = Vectors(data.Normals);
            }

            return mesh;
        }

        private Material Make(Doc.Material from)
        {
            Material material = template != null ? new Material(template) : new Material(Shader.Find("Standard"));
            material.name = from.Name;

            // The file's colour is linear, a material's property is not.
            material.color = new Color((float)from.Color.R, (float)from.Color.G, (float)from.Color.B, (float)from.Color.A).gamma;
            Set(material, "_Metallic", from.Metallic);
            Set(material, "_Glossiness", from.Smoothness); // Standard
            Set(material, "_Smoothness", from.Smoothness); // URP and HDRP Lit
            return material;
        }

        private static void Set(Material material, string property, double value)
        {
            if (material.HasProperty(property))
            {
                material.SetFloat(property, (float)value);
            }
        }

        private static Vector3[] Vectors(ReadOnlySpan<float> numbers)
        {
            var vectors = new Vector3[numbers.Length / 3];
            for (int i = 0; i < vectors.Length; i++)
            {
                vectors[i] = new Vector3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
            }

            return vectors;
        }

        private static Vector2[] Pairs(ReadOnlySpan<float> numbers)
        {
            var pairs = new Vector2[numbers.Length / 2];
            for (int i = 0; i < pairs.Length; i++)
            {
                pairs[i] = new Vector2(numbers[2 * i], numbers[2 * i + 1]);
            }

            return pairs;
        }

        private static int[] Indices(MeshData data, Doc.Submesh part)
        {
            var indices = new int[part.IndexCount];
            for (int i = 0; i < indices.Length; i++)
            {
                int at = part.IndexStart + i;
                indices[i] = data.Indices16.IsEmpty ? (int)data.Indices32[at] : data.Indices16[at];
            }

            return indices;
        }
    }
}
