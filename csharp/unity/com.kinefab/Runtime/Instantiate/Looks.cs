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
        private const int UvSets = 8;
        private readonly ValidScene scene;
        private readonly KinefabSettings settings;
        private readonly Surfaces surfaces;
        private readonly Func<int, Material> replaced;
        private readonly Mesh[] meshes;
        private readonly Material[] materials;
        private readonly PhysicsMaterial[] physicsMaterials;
        private readonly bool[] touched;
        private readonly bool[] bumpy;
        private readonly List<KinefabFinding> findings;

        /// <param name="scene">Whose looks they are.</param>
        /// <param name="settings">Whether meshes stay readable, and what the surfaces are copies of.</param>
        /// <param name="findings">Gets what the project lacks, and what its shaders have no place for.</param>
        /// <param name="replaced">The user's own material in the place of one of the file, by its index; null: the file's.</param>
        internal Looks(ValidScene scene, KinefabSettings settings, List<KinefabFinding> findings, Func<int, Material> replaced)
        {
            this.scene = scene;
            this.settings = settings;
            this.findings = findings;
            surfaces = new Surfaces(scene.Document, settings.material, findings);
            Identities = new Identities(scene.Document);
            this.replaced = replaced;
            meshes = new Mesh[scene.Document.Meshes.Count];
            materials = new Material[scene.Document.Materials.Count];
            physicsMaterials = new PhysicsMaterial[scene.Document.PhysicsMaterials.Count];
            touched = Touched(scene.Document);
            bumpy = Bumpy(scene.Document);
        }

        /// <summary>What each is in the source.</summary>
        internal Identities Identities { get; }

        /// <summary>Called with each mesh when it is made, before it is closed to scripts.</summary>
        internal Action<Mesh> Finish { get; set; }

        /// <summary>Those that were asked for; null stands for the others.</summary>
        internal IReadOnlyList<Mesh> Meshes => meshes;

        /// <summary>Those that were asked for; null stands for the others.</summary>
        internal IReadOnlyList<Material> Materials => materials;

        /// <summary>Those that were asked for; null stands for the others.</summary>
        internal IReadOnlyList<PhysicsMaterial> PhysicsMaterials => physicsMaterials;

        /// <summary>By what they are in the source; null stands for what Unity could not read.</summary>
        internal IReadOnlyDictionary<string, Texture2D> Textures => surfaces.Textures.Made;

        internal Mesh Mesh(int index) => meshes[index] != null ? meshes[index] : meshes[index] = Make(index);

        internal Material Material(int index)
        {
            if (materials[index] == null)
            {
                // Made in any case: what there is to replace does not depend on what is replaced.
                materials[index] = surfaces.Make(scene.Document.Materials[index], Identities.Materials[index]);
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

        // Those that show a normal map.
        private static bool[] Bumpy(Doc.SceneDocument document)
        {
            var bumpy = new bool[document.Meshes.Count];
            foreach (Doc.GameObject from in document.GameObjects)
            {
                bool shows = false;
                foreach (Doc.Component component in from.Components)
                {
                    if (component is Doc.MeshRenderer renderer)
                    {
                        foreach (int material in renderer.Materials)
                        {
                            shows |= document.Materials[material].NormalTexture != null;
                        }
                    }
                }

                foreach (Doc.Component component in from.Components)
                {
                    if (shows && component is Doc.MeshFilter filter)
                    {
                        bumpy[filter.Mesh] = true;
                    }
                }
            }

            return bumpy;
        }

        private Mesh Make(int index)
        {
            MeshData data = scene.Mesh(index);
            Doc.Mesh from = data.Mesh;

            // The size of an index first: 65,536 vertices and more do not fit the smaller one.
            var mesh = new Mesh { name = from.Name, indexFormat = (IndexFormat)from.IndexFormat, vertices = Vectors(data.Positions) };
            mesh.subMeshCount = from.Submeshes.Count;
            for (int i = 0; i < from.Submeshes.Count; i++)
            {
                mesh.SetTriangles(Indices(data, from.Submeshes[i]), i);
            }

            for (int set = 0; set < UvSets; set++)
            {
                ReadOnlySpan<float> uv = data.UvOf(set);
                if (!uv.IsEmpty)
                {
                    mesh.SetUVs(set, Pairs(uv));
                }
            }

            if (data.Normals.IsEmpty)
            {
                mesh.RecalculateNormals();
            }
            else
            {
                mesh.normals = Vectors(data.Normals);
            }

            if (!data.Tangents.IsEmpty)
            {
                mesh.tangents = Fours(data.Tangents, (x, y, z, w) => new Vector4(x, y, z, w));
            }
            else if (bumpy[index] && !data.Uv.IsEmpty)
            {
                mesh.RecalculateTangents();
            }

            if (!data.Colors.IsEmpty)
            {
                mesh.colors = Fours(data.Colors, (r, g, b, a) => new Color(r, g, b, a));
                string feature = $"vertex colours of mesh {from.Name}";
                findings.Add(KinefabFinding.Of("LOOK_NOT_SHOWN", feature, ("feature", feature), ("shader", "the pipeline's standard shader")));
            }

            mesh.RecalculateBounds();
            Finish?.Invoke(mesh);
            if (!settings.readWrite && !touched[index])
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

        private static T[] Fours<T>(ReadOnlySpan<float> numbers, Func<float, float, float, float, T> made)
        {
            var fours = new T[numbers.Length / 4];
            for (int i = 0; i < fours.Length; i++)
            {
                fours[i] = made(numbers[4 * i], numbers[4 * i + 1], numbers[4 * i + 2], numbers[4 * i + 3]);
            }

            return fours;
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
