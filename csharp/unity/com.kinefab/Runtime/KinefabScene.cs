using System;
using System.Collections.Generic;
using System.IO;
using Kinefab.Diagnostics;
using Kinefab.Validation;
using UnityEngine;

namespace KinefabUnity
{
    /// <summary>Mechanisms from <c>.kinefab</c> files, made while the game runs; in the editor a file in Assets imports by itself.</summary>
    public static class KinefabScene
    {
        /// <summary>Makes the objects of a file. Faulty data gives findings, never an exception.</summary>
        /// <param name="path">A file NAME.kinefab, its buffers beside it.</param>
        /// <param name="parent">Where the mechanism goes, which may be placed, turned and evenly scaled; null: to the top of the hierarchy.</param>
        /// <param name="settings">Null: the default ones.</param>
        /// <param name="findings">Gets what was found; null: it goes to the Console.</param>
        /// <returns>The root, which holds all objects; null where the file has errors.</returns>
        public static GameObject Instantiate(string path, Transform parent = null, KinefabSettings settings = null, List<KinefabFinding> findings = null) =>
            Make(() => File.ReadAllBytes(path), () => ValidScene.Load(path), Path.GetFileNameWithoutExtension(path), parent, settings, findings);

        /// <summary>As the other, of a file in memory.</summary>
        /// <param name="file">What the file holds; kept, and must not be changed any more.</param>
        /// <param name="parent">Where the mechanism goes, which may be placed, turned and evenly scaled; null: to the top of the hierarchy.</param>
        /// <param name="settings">Null: the default ones.</param>
        /// <param name="findings">Gets what was found; null: it goes to the Console.</param>
        /// <param name="buffers">Gives the bytes of a buffer by its name, or null where there is none; null: there are no buffers.</param>
        /// <returns>The root, which holds all objects; null where the file has errors.</returns>
        public static GameObject Instantiate(byte[] file, Transform parent = null, KinefabSettings settings = null, List<KinefabFinding> findings = null, Func<string, byte[]> buffers = null) =>
            Make(() => file, () => ValidScene.Load(file, buffers == null ? (Func<string, ReadOnlyMemory<byte>?>)null : uri => buffers(uri) is byte[] found ? found : (ReadOnlyMemory<byte>?)null), "Mechanism", parent, settings, findings);

        private static GameObject Make(Func<byte[]> text, Func<ValidScene> load, string name, Transform parent, KinefabSettings settings, List<KinefabFinding> findings)
        {
            var found = new List<KinefabFinding>();
            GameObject root = null;
            try
            {
                ValidScene scene = load();
                KinefabFinding.Add(scene.Report, found);
                settings = settings ?? new KinefabSettings();
                scene = Articulation.Apply(Ground.Apply(scene, settings.ground, found), settings.physics, found);
                KinefabFinding.AddLosses(scene.Document, found);
                var builder = new SceneBuilder(scene, settings, found);
                root = builder.Build(ObjectNames.Plain(name), parent);
                builder.Move(KinefabSource.Of(text(), settings));
            }
            catch (SceneFormatException fault)
            {
                KinefabFinding.Add(fault.Report, found);
            }

            if (findings != null)
            {
                findings.AddRange(found);
            }
            else
            {
                Tell(found, root);
            }

            return root;
        }

        private static void Tell(List<KinefabFinding> found, GameObject root)
        {
            foreach (KinefabFinding finding in found)
            {
                if (finding.severity == KinefabSeverity.Error && root == null)
                {
                    Debug.LogError(finding.ToString());
                }
                else if (finding.severity != KinefabSeverity.Info)
                {
                    Debug.LogWarning(finding.ToString(), root);
                }
            }
        }
    }
}
