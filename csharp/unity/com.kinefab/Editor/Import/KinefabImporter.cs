using System;
using System.Collections.Generic;
using System.IO;
using Kinefab.Diagnostics;
using Kinefab.Validation;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;
using Doc = Kinefab.Document;
using Object = UnityEngine.Object;

namespace KinefabUnity.Editing
{
    /// <summary>
    /// Imports a <c>.kinefab</c> as a prefab: objects with joints, meshes, materials, clips, and a KinefabMechanism that moves them. A file
    /// with errors becomes no asset at all; each error is told with its line and place.
    /// </summary>
    /// <remarks>Raise the version when the same file gives another asset: every project then imports its files anew.</remarks>
    [ScriptedImporter(1, "kinefab")]
    public sealed class KinefabImporter : ScriptedImporter
    {
        // Of parts: from here on the editor shows how far it is.
        private const int Many = 1000;

        [SerializeField]
        private KinefabSettings settings = new KinefabSettings();

        /// <summary>How the file becomes objects; after a change call SaveAndReimport.</summary>
        public KinefabSettings Settings => settings;

        /// <summary>Of Unity: materials may be replaced by the user's own.</summary>
        public override bool SupportsRemappedAssetType(Type type) => type == typeof(Material);

        /// <summary>Of Unity: makes the asset.</summary>
        public override void OnImportAsset(AssetImportContext ctx)
        {
            var findings = new List<KinefabFinding>();
            try
            {
                Import(ctx, findings);
            }
            catch (SceneFormatException fault)
            {
                KinefabFinding.Add(fault.Report, findings);
            }
            catch (Exception fault)
            {
                // Anything else would leave the asset half made, and the user without a sentence.
                findings.Add(KinefabFinding.Of("UNITY_IMPORT_FAILED", "", ("detail", $"{fault.GetType().Name}: {fault.Message}")));
                Debug.LogException(fault);
            }
            finally
            {
                EditorUtility.ClearProgressBar();
            }

            Tell(ctx, findings);
        }

        // Called by Unity before the import, also of faulty files: what lies beside it is imported first.
        private static string[] GatherDependenciesFromSourceFile(string path) => ImportedFile.Beside(path, Doc.SceneFile.Load(FileUtil.GetPhysicalPath(path)).Document);

        private void Import(AssetImportContext ctx, List<KinefabFinding> findings)
        {
            ctx.DependsOnCustomDependency(ProjectDependency.Name);
            Doc.SceneReading reading = Doc.SceneFile.Load(FileUtil.GetPhysicalPath(ctx.assetPath));
            foreach (string beside in ImportedFile.Beside(ctx.assetPath, reading.Document))
            {
                // Also of a file that is not there yet: the asset is imported again when it comes.
                ctx.DependsOnSourceAsset(beside);
            }

            ValidScene scene = ImportedFile.Validated(reading);
            KinefabFinding.Add(reading.Report, findings);
            KinefabFinding.Add(scene.Report, findings);
            scene = Articulation.Apply(Ground.Apply(scene, settings.ground, findings), settings.physics, findings);
            KinefabFinding.AddLosses(scene.Document, findings);

            var external = GetExternalObjectMap();
            SceneBuilder builder = null;
            builder = new SceneBuilder(scene, settings, findings, i => Replaced(external, builder.Looks.Identities.Materials[i]));
            builder.Looks.Finish = mesh =>
            {
                if (settings.lightmapUVs)
                {
                    Unwrapping.GenerateSecondaryUVSet(mesh);
                }
            };
            if (scene.Document.GameObjects.Count >= Many)
            {
                string title = $"Importing {Path.GetFileName(ctx.assetPath)}";
                builder.Progress = share => EditorUtility.DisplayProgressBar(title, $"{scene.Document.GameObjects.Count} parts", share);
            }

            // Its name is none of the file's: by it Unity finds the objects of the asset again.
            GameObject root = builder.Build("Mechanism", null);
            try
            {
                Add(ctx, builder, root, findings);
            }
            catch
            {
                builder.Clear();
                throw;
            }
        }

        private void Add(AssetImportContext ctx, SceneBuilder builder, GameObject root, List<KinefabFinding> findings)
        {
            ProjectFindings.Add(builder, settings, findings);
            KinefabSource source = KinefabSource.Of(File.ReadAllBytes(FileUtil.GetPhysicalPath(ctx.assetPath)), settings);
            builder.Move(source);
            source.Tell(findings);
            var made = new List<(string Identifier, Object Object)>();
            Looks looks = builder.Looks;
            Collect(made, "meshes/", looks.Identities.Meshes, looks.Meshes);
            Collect(made, "textures/", new List<string>(looks.Textures.Keys), new List<Object>(looks.Textures.Values));
            Collect(made, "materials/", looks.Identities.Materials, looks.Materials);
            Collect(made, "physicsMaterials/", looks.Identities.PhysicsMaterials, looks.PhysicsMaterials);
            Collect(made, "clips/", looks.Identities.Clips, builder.AnimationClips);
            made.Add(("source", source));
            made.Add(("root", root));

            // All at once: what could fail has been done.
            foreach ((string identifier, Object one) in made)
            {
                ctx.AddObjectToAsset(identifier, one);
            }

            ctx.SetMainObject(root);
        }

        private static void Collect(List<(string Identifier, Object Object)> made, string kind, IReadOnlyList<string> identities, IReadOnlyList<Object> objects)
        {
            for (int i = 0; i < objects.Count; i++)
            {
                if (objects[i] != null)
                {
                    made.Add((kind + identities[i], objects[i]));
                }
            }
        }

        private static Material Replaced(Dictionary<SourceAssetIdentifier, Object> external, string identity) =>
            external.TryGetValue(new SourceAssetIdentifier(typeof(Material), identity), out Object found) ? found as Material : null;

        private static void Tell(AssetImportContext ctx, List<KinefabFinding> findings)
        {
            foreach (KinefabFinding finding in findings)
            {
                if (finding.severity == KinefabSeverity.Error && ctx.mainObject == null)
                {
                    ctx.LogImportError($"{ctx.assetPath}: {finding}");
                }
                else if (finding.severity != KinefabSeverity.Info)
                {
                    ctx.LogImportWarning($"{ctx.assetPath}: {finding}");
                }
            }
        }
    }
}
