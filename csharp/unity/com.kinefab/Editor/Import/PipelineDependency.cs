using UnityEditor;
using UnityEngine;
using UnityEngine.Rendering;

namespace KinefabUnity.Editing
{
    /// <summary>What imported materials are made for: when the project's render pipeline changes, its files are imported anew.</summary>
    internal static class PipelineDependency
    {
        internal const string Name = "Kinefab/RenderPipeline";

        [InitializeOnLoadMethod]
        private static void Register()
        {
            Renew();
            RenderPipelineManager.activeRenderPipelineTypeChanged += Renew;
        }

        private static void Renew()
        {
            RenderPipelineAsset pipeline = GraphicsSettings.currentRenderPipeline;
            AssetDatabase.RegisterCustomDependency(Name, Hash128.Compute(pipeline == null ? "built-in" : pipeline.GetType().FullName));
        }
    }
}
