using System;
using System.Collections.Generic;
using System.Globalization;
using Kinefab.Document;

namespace KinefabUnity
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
            Materials = Named(document.Materials, one => one.Name, one => Held(document, one));
            PhysicsMaterials = Named(document.PhysicsMaterials, one => one.Name, Held);
            Clips = Named(document.Animations, one => one.Name, one => Held(document, one));
        }

        /// <summary>The least id of the objects that show it, or that touch by it and what they do so by.</summary>
        internal IReadOnlyList<string> Meshes { get; }

        /// <summary>Their names; of several alike also what they hold. Users remap materials by these.</summary>
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

            return Named(found, one => one, one => "");
        }

        private static void Least(ref string known, string id)
        {
            if (known == null || string.CompareOrdinal(id, known) < 0)
            {
                known = id;
            }
        }

        // What is alike in all that is told gets numbers, in the file's order.
        private static string[] Named<T>(IReadOnlyList<T> nouns, Func<T, string> name, Func<T, string> held)
        {
            var counts = new Dictionary<string, int>();
            foreach (T noun in nouns)
            {
                counts[name(noun)] = counts.TryGetValue(name(noun), out int before) ? before + 1 : 1;
            }

            var taken = new HashSet<string>();
            var found = new string[nouns.Count];
            for (int i = 0; i < found.Length; i++)
            {
                string told = name(nouns[i]), more = counts[told] > 1 ? held(nouns[i]) : "";
                told = more.Length > 0 ? $"{told}|{Digest.Of(more)}" : told;
                found[i] = told;
                for (int number = 2; !taken.Add(found[i]); number++)
                {
                    found[i] = $"{told}#{number}";
                }
            }

            return found;
        }

        private static string Held(SceneDocument document, Material one)
        {
            var told = new List<string>
            {
                Numbers(one.Color.R, one.Color.G, one.Color.B, one.Color.A, one.Metallic, one.Smoothness, one.AlphaCutoff, one.Emission.X, one.Emission.Y, one.Emission.Z),
                $"{one.AlphaMode}{one.DoubleSided}",
            };
            foreach (Texture texture in new[] { one.ColorTexture, one.NormalTexture, one.MetallicRoughnessTexture, one.OcclusionTexture, one.EmissionTexture })
            {
                told.Add(texture == null ? "" : $"{Digest.Of(document.BytesOf(document.Images[texture.Image]))} {texture.Wrap}"
                    + Numbers(texture.UvSet, texture.Scale.X, texture.Scale.Y, texture.Offset.X, texture.Offset.Y, texture.Rotation));
            }

            return string.Join("|", told);
        }

        private static string Held(PhysicsMaterial one) =>
            Numbers(one.DynamicFriction, one.StaticFriction, one.Bounciness, (int)one.FrictionCombine, (int)one.BounceCombine);

        // What it moves, and how long.
        private static string Held(SceneDocument document, AnimationClip one)
        {
            var told = new List<string>();
            foreach (AnimationTrack track in one.Tracks)
            {
                told.Add(document.GameObjects[track.GameObject].Id);
            }

            told.Sort(StringComparer.Ordinal);
            return string.Join("|", told) + Numbers(new List<double>(one.Times).ToArray());
        }

        private static string Numbers(params double[] values) =>
            string.Join(" ", Array.ConvertAll(values, value => value.ToString("R", CultureInfo.InvariantCulture)));
    }
}
