using System.Collections.Generic;
using Kinefab.Diagnostics;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;
using Doc = Kinefab.Document;
using Object = UnityEngine.Object;

namespace KinefabUnity.Editing
{
    /// <summary>The inspector of a <c>.kinefab</c>: settings, materials to replace, and what was found, each with what to do.</summary>
    [CustomEditor(typeof(KinefabImporter))]
    public sealed class KinefabImporterEditor : ScriptedImporterEditor
    {
        private const string UseWorld = "Use These in This Project";

        // What is shown of the file, and the import that it was read of.
        private Hash128 import;
        private List<KinefabFinding> findings;
        private string exported, world;
        private bool showsMaterials, showsFindings = true;

        /// <summary>Of Unity.</summary>
        public override void OnInspectorGUI()
        {
            serializedObject.Update();
            EditorGUILayout.PropertyField(serializedObject.FindProperty("settings"), true);
            serializedObject.ApplyModifiedProperties();
            var importer = (KinefabImporter)target;
            ForgetBefore(importer);
            Physics(importer);
            Materials(importer);
            Findings(importer);
            ApplyRevertGUI();
        }

        /// <summary>What the import found; of a file that became no asset what is wrong with it.</summary>
        internal static List<KinefabFinding> Of(string assetPath)
        {
            var found = new List<KinefabFinding>();
            KinefabSource source = AssetDatabase.LoadAssetAtPath<KinefabSource>(assetPath);
            if (source != null)
            {
                found.AddRange(source.Findings);
                return found;
            }

            try
            {
                ImportedFile.Validated(Doc.SceneFile.Load(FileUtil.GetPhysicalPath(assetPath)));
            }
            catch (SceneFormatException fault)
            {
                KinefabFinding.Add(fault.Report, found);
            }

            return found;
        }

        // Settings that are applied, and a second export, import the file anew.
        private void ForgetBefore(KinefabImporter importer)
        {
            Hash128 now = AssetDatabase.GetAssetDependencyHash(importer.assetPath);
            if (!now.Equals(import))
            {
                import = now;
                findings = null;
                exported = world = null;
            }
        }

        // What "As Exported" is of this file, and the world that its mechanism was made for, which no prefab brings.
        private void Physics(KinefabImporter importer)
        {
            KinefabSource source = AssetDatabase.LoadAssetAtPath<KinefabSource>(importer.assetPath);
            if (source == null)
            {
                return;
            }

            exported = exported ?? source.DescribePhysics();
            if (exported.Length > 0)
            {
                EditorGUILayout.HelpBox($"The file has {exported}.", MessageType.None);
            }

            world = world ?? source.DescribeWorld();
            EditorGUILayout.HelpBox($"Made for {world}.", MessageType.None);
            if (GUILayout.Button(UseWorld))
            {
                source.ApplyProjectSettings();
            }
        }

        private void Materials(KinefabImporter importer)
        {
            showsMaterials = EditorGUILayout.Foldout(showsMaterials, "Materials", true);
            if (!showsMaterials)
            {
                return;
            }

            Dictionary<AssetImporter.SourceAssetIdentifier, Object> external = importer.GetExternalObjectMap();
            foreach (Object made in AssetDatabase.LoadAllAssetsAtPath(importer.assetPath))
            {
                if (made is Material material)
                {
                    Replace(importer, external, material);
                }
            }
        }

        private static void Replace(KinefabImporter importer, Dictionary<AssetImporter.SourceAssetIdentifier, Object> external, Material material)
        {
            var identifier = new AssetImporter.SourceAssetIdentifier(typeof(Material), material.name);
            external.TryGetValue(identifier, out Object before);
            Object after = EditorGUILayout.ObjectField(material.name, before, typeof(Material), false);
            if (after == before)
            {
                return;
            }

            if (after == null)
            {
                importer.RemoveRemap(identifier);
            }
            else
            {
                importer.AddRemap(identifier, after);
            }

            importer.SaveAndReimport();
        }

        private void Findings(KinefabImporter importer)
        {
            findings = findings ?? Of(importer.assetPath);
            showsFindings = EditorGUILayout.Foldout(showsFindings, $"Findings ({findings.Count})", true);
            if (!showsFindings)
            {
                return;
            }

            foreach (KinefabFinding finding in findings)
            {
                EditorGUILayout.HelpBox(finding.ToString(), Kind(finding.severity));
            }
        }

        private static MessageType Kind(KinefabSeverity severity) =>
            severity == KinefabSeverity.Error ? MessageType.Error : severity == KinefabSeverity.Warning ? MessageType.Warning : MessageType.Info;
    }
}
