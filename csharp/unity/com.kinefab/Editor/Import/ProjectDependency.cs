using UnityEditor;
using UnityEngine;
using UnityEngine.Rendering;

namespace KinefabUnity.Editing
{
    /// <summary>
    /// What an import depends on beside its file: the render pipeline, which materials are made for, and the editor, whose bodies and joints
    /// have other fields from version to version. When one of them changes, the project's files are imported anew.
    /// </summary>
    internal static class ProjectDependency
    {
        internal const string Name = "Kinefab/Project";

        [InitializeOnLoadMethod]
        private static void Register()
        {
            Renew();
            RenderPipelineManager.activeRenderPipelineTypeChanged += Change;
        }

        private static void Renew()
        {
            RenderPipelineAsset pipeline = GraphicsSettings.currentRenderPipeline;
            string kind = pipeline == null ? "built-in" : pipeline.GetType().FullName;
            AssetDatabase.RegisterCustomDependency(Name, Hash128.Compute($"{kind} {Application.unityVersion}"));
        }

        private static void Change()
        {
            Renew();

            // Unity looks at dependencies only when it refreshes, which it does not where a pipeline changes; and never in the middle of a frame.
            if (!Application.isPlaying && !AssetDatabase.IsAssetImportWorkerProcess())
            {
                EditorApplication.delayCall += AssetDatabase.Refresh;
            }
        }
    }
}
