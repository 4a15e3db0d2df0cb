using System;
using System.Collections.Generic;
using Kinefab.Document;

namespace KinefabUnity.Editing
{
    /// <summary>
    /// By what Unity finds the parts of an asset again when its file has changed: made of ids and names, never of an order. They
    /// are the package's promise to every project that refers to them.
    /// </summary>
    internal sealed class Identities
    {
        internal Identities(SceneDocument document)
        {
            Meshes = OfMeshes(document);
            Materials = Named(document.Materials.Count, i => document.Materials[i].Name);
            PhysicsMaterials = Named(document.PhysicsMaterials.Count, i => document.PhysicsMaterials[i].Name);
            Clips = Named(document.Animations.Count, i => document.Animations[i].Name);
        }

        /// <summary>The least id of the objects that show it, or that touch by it and what they do so by.</summary>
        internal IReadOnlyList<string> Meshes { get; }

        /// <summary>Their names; of several alike with a number. Users remap materials by these.</summary>
        internal IReadOnlyList<string> Materials { get; }

        /// <summary>Of each physics material.</summary>
        internal IReadOnlyList<string> PhysicsMaterials { get; }

        /// <summary>As materials.</summary>
        internal IReadOnlyList<string> Clips { get; }

        private static string[] OfMeshes(SceneDocument document)
        {
            var shown = new string[document.Meshes.Count];
            var touched = new string[document.Meshes.Count];
            foreach (GameObject from in document.GameObjects)
            {
                int colliders = 0;
                foreach (Component component in from.Components)
                {
                    if (component is MeshFilter filter)
                    {
                        Least(ref shown[filter.Mesh], from.Id);
                    }
                    else if (component is MeshCollider collider)
                    {
                        Least(ref touched[collider.Mesh], $"{from.Id}|collider {colliders++}");
                    }
                }
            }

            var found = new string[shown.Length];
            for (int i = 0; i < found.Length; i++)
            {
                found[i] = shown[i] ?? touched[i] ?? $"unused {i}";
            }

            return Named(found.Length, i => found[i]);
        }

        private static void Least(ref string known, string id)
        {
            if (known == null || string.CompareOrdinal(id, known) < 0)
            {
                known = id;
            }
        }

        private static string[] Named(int count, Func<int, string> name)
        {
            var taken = new HashSet<string>();
            var found = new string[count];
            for (int i = 0; i < count; i++)
            {
                found[i] = name(i);
                for (int more = 2; !taken.Add(found[i]); more++)
                {
                    found[i] = $"{name(i)}#{more}";
                }
            }

            return found;
        }
    }
}
