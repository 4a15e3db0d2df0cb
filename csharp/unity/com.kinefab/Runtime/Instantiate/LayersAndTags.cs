using System.Collections.Generic;
using UnityEngine;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>Layers and tags by the source's words for them. Both lists are the project's: a word that it lacks is told once, with how many wanted it.</summary>
    internal sealed class LayersAndTags
    {
        private readonly List<KinefabFinding> findings;
        private readonly Dictionary<string, List<string>> lacking = new Dictionary<string, List<string>>();

        /// <param name="findings">Gets what the project lacks.</param>
        internal LayersAndTags(List<KinefabFinding> findings) => this.findings = findings;

        internal void Set(GameObject to, Doc.GameObject from)
        {
            if (!string.IsNullOrEmpty(from.Layer))
            {
                int layer = LayerMask.NameToLayer(from.Layer);
                if (layer >= 0)
                {
                    to.layer = layer;
                }
                else
                {
                    Lack("layer", from.Layer, from.Id);
                }
            }

            if (string.IsNullOrEmpty(from.Tag))
            {
                return;
            }

            try
            {
                to.tag = from.Tag;
            }
            catch (UnityException)
            {
                Lack("tag", from.Tag, from.Id); // Unity has no other way to ask
            }
        }

        internal void Tell()
        {
            foreach (KeyValuePair<string, List<string>> word in lacking)
            {
                int at = word.Key.IndexOf(' ');
                findings.Add(KinefabFinding.Of(
                    "UNITY_LAYER_OR_TAG_MISSING", word.Value[0], ("kind", word.Key.Substring(0, at)), ("word", word.Key.Substring(at + 1)), ("count", word.Value.Count.ToString()), ("object", word.Value[0])));
            }
        }

        private void Lack(string kind, string word, string id)
        {
            string key = $"{kind} {word}";
            if (!lacking.TryGetValue(key, out List<string> ids))
            {
                lacking[key] = ids = new List<string>();
            }

            ids.Add(id);
        }
    }
}
