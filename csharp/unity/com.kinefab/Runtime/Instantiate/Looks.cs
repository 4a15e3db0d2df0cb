using System;
using System.Collections.Generic;
using Kinefab.Validation;
using UnityEngine;
using UnityEngine.Rendering;
using Doc = Kinefab.Document;
#if UNITY_6000_0_OR_NEWER
using PhysicsMaterial = UnityEngine.PhysicsMaterial;
using PhysicsMaterialCombine = UnityEngine.PhysicsMaterialCombine;
#else
using PhysicsMaterial = UnityEngine.PhysicMaterial;
using PhysicsMaterialCombine = UnityEngine.PhysicMaterialCombine;
#endif

namespace KinefabUnity
{
    /// <summary>Meshes, materials and physics materials of a scene, each made when it is first asked for and shared by all that show it.</summary>
    internal sealed class Looks
    {
        private readonly ValidScene scene;
        private readonly KinefabSettings settings;
        private readonly Surfaces surfaces;
        private readonly Func<int, Material> replaced;
        private readonly Mesh[] meshes;
        private readonly Material[] materials;
        private readonly PhysicsMaterial[] physicsMaterials;
        private readonly bool[] touched;

        /// <param name="scene">Whose looks they are.</param>
        /// <param name="settings">Whether meshes stay readable.</param>
        /// <param name="surfaces">Makes the materials.</param>
        /// <param name="replaced">The user's own material in the place of one of the file, by its index; null: the file's.</param>
        internal Looks(ValidScene scene, KinefabSettings settings, Surfaces surfaces, Func<int, Material> replaced)
        {
            this.scene = scene;
            this.settings = settings;
            this.surfaces = surfaces;
            this.replaced = replaced;
            meshes = new Mesh[scene.Document.Meshes.Count];
            materials = new Material[scene.Document.Materials.Count];
            physicsMaterials = new PhysicsMaterial[scene.Document.PhysicsMaterials.Count];
            touched = Touched(scene.Document);
        }

        /// <summary>Called with each mesh when it is made, before it is closed to scripts.</summary>
        internal Action<Mesh> Finish { get; set; }

        /// <summary>Those that were asked for; null stands for the others.</summary>
        internal IReadOnlyList<Mesh> Meshes => meshes;

        /// <summary>Those that were asked for; null stands for the others.</summary>
        internal IReadOnlyList<Material> Materials => materials;

        /// <summary>Those that were asked for; null stands for the others.</summary>
        internal IReadOnlyList<PhysicsMaterial> PhysicsMaterials => physicsMaterials;

        internal Mesh Mesh(int index) => meshes[index] != null ? meshes[index] : meshes[index] = Make(scene.Mesh(index), touched[index]);

        internal Material Material(int index)
        {
            if (materials[index] == null)
            {
                // Made in any case: what there is to replace does not depend on what is replaced.
                materials[index] = surfaces.Make(scene.Document.Materials[index]);
            }

            Material own = replaced?.Invoke(index);
            return own != null ? own : materials[index];
        }

        internal PhysicsMaterial PhysicsMaterial(int index)
        {
            if (physicsMaterials[index] == null)
            {
                Doc.PhysicsMaterial from = scene.Document.PhysicsMaterials[index];
                physicsMaterials[index] = new PhysicsMaterial(from.Name)
                {
                    dynamicFriction = (float)from.DynamicFriction,
                    staticFriction = (float)from.StaticFriction,
                    bounciness = (float)from.Bounciness,
                    frictionCombine = (PhysicsMaterialCombine)from.FrictionCombine,
                    bounceCombine = (PhysicsMaterialCombine)from.BounceCombine,
                };
            }

            return physicsMaterials[index];
        }

        // Unity cooks the shapes of colliders from numbers that it may read.
        private static bool[] Touched(Doc.SceneDocument document)
        {
            var touched = new bool[document.Meshes.Count];
            foreach (Doc.GameObject from in document.GameObjects)
            {
                foreach (Doc.Component component in from.Components)
                {
                    if (component is Doc.MeshCollider collider)
                    {
                        touched[collider.Mesh] = true;
                    }
                }
            }

            return touched;
        }

        private Mesh Make(MeshData data, bool isTouched)
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

            mesh.RecalculateBounds();
            Finish?.Invoke(mesh);
            if (!settings.readWrite && !isTouched)
            {
                mesh.UploadMeshData(markNoLongerReadable: true);
            }

            return mesh;
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
