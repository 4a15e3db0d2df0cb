using System;
using System.Collections.Generic;
using System.Globalization;
using System.Text;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>
    /// Names of GameObjects, each once below its parent: by them Unity finds an imported object again, and clips what they move.
    /// The same names as the exporter's prefabs have (names.py).
    /// </summary>
    internal static class ObjectNames
    {
        private const int Digits = 6;

        /// <summary>Of the objects of a file, in its order.</summary>
        internal static string[] Of(Doc.SceneDocument document)
        {
            var parents = new int[document.GameObjects.Count];
            string[] names = new string[parents.Length], ids = new string[parents.Length];
            for (int i = 0; i < parents.Length; i++)
            {
                Doc.GameObject from = document.GameObjects[i];
                (parents[i], names[i], ids[i]) = (from.Parent ?? -1, from.Name, from.Id);
            }

            return Of(parents, names, ids);
        }

        /// <summary>Of objects by their parents, names and ids, in one order; a parent of -1 is none.</summary>
        internal static string[] Of(IReadOnlyList<int> parents, IReadOnlyList<string> names, IReadOnlyList<string> ids)
        {
            var below = new Dictionary<int, List<int>>();
            for (int i = 0; i < names.Count; i++)
            {
                if (!below.TryGetValue(parents[i], out List<int> members))
                {
                    below[parents[i]] = members = new List<int>();
                }

                members.Add(i);
            }

            var found = new string[names.Count];
            foreach (List<int> members in below.Values)
            {
                string[] unique = Unique(members.ConvertAll(i => Plain(names[i])), members.ConvertAll(i => ids[i]));
                for (int k = 0; k < members.Count; k++)
                {
                    found[members[k]] = unique[k];
                }
            }

            return found;
        }

        /// <summary>
        /// Each once. Of several alike the one that is first by its id keeps the name, the others get digits made of theirs: a name
        /// depends on no order, and seldom on what else is there.
        /// </summary>
        internal static string[] Unique(IReadOnlyList<string> names, IReadOnlyList<string> ids)
        {
            var alike = new Dictionary<string, List<int>>();
            for (int i = 0; i < names.Count; i++)
            {
                if (!alike.TryGetValue(names[i], out List<int> members))
                {
                    alike[names[i]] = members = new List<int>();
                }

                members.Add(i);
            }

            var found = new string[names.Count];
            var taken = new HashSet<string>(alike.Keys);
            foreach (List<int> members in alike.Values)
            {
                members.Sort((a, b) => string.CompareOrdinal(ids[a], ids[b]) is int order && order != 0 ? order : a.CompareTo(b));
                found[members[0]] = names[members[0]];
                for (int k = 1; k < members.Count; k++)
                {
                    int i = members[k];
                    string tail = Hash(ids[i]);
                    for (int count = 2; !taken.Add($"{names[i]}~{tail}"); count++)
                    {
                        tail = Hash($"{ids[i]}#{count}");
                    }

                    found[i] = $"{names[i]}~{tail}";
                }
            }

            return found;
        }

        /// <summary>Without slashes, which divide paths, and without control characters; never empty.</summary>
        internal static string Plain(string name)
        {
            var plain = new StringBuilder(name.Length);
            for (int i = 0; i < name.Length; i++)
            {
                if (char.IsSurrogatePair(name, i))
                {
                    plain.Append(name, i++, 2);
                    continue;
                }

                UnicodeCategory kind = char.GetUnicodeCategory(name, i);
                bool isHidden = kind == UnicodeCategory.Control || kind == UnicodeCategory.Surrogate || kind == UnicodeCategory.LineSeparator || kind == UnicodeCategory.ParagraphSeparator;
                plain.Append(name[i] == '/' || isHidden ? '_' : name[i]);
            }

            string found = plain.ToString().Trim();
            return found.Length == 0 ? "_" : found;
        }

        private static string Hash(string id) => Digest.Of(id).Substring(0, Digits);
    }
}
