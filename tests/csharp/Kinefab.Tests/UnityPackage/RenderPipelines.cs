using System;
using UnityEngine.Rendering;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>Projects of the three pipelines, as far as an importer sees them: the material that a new object gets, with the properties of its shader.</summary>
internal sealed class RenderPipelines : IDisposable
{
    private static readonly string[] Both =
    [
        "_Color", "_BaseColor", "_EmissionColor", "_Cutoff", "_Metallic", "_Glossiness", "_SrcBlend", "_DstBlend", "_ZWrite", "_BumpScale", "_MainTex", "_Smoothness",
    ];

    private static readonly string[] Urp =
    [
        .. Both, "_GlossMapScale", "_OcclusionStrength", "_SmoothnessTextureChannel", "_WorkflowMode", "_Surface", "_Blend", "_BlendModePreserveSpecular", "_SrcBlendAlpha",
        "_DstBlendAlpha", "_AlphaClip", "_AlphaToMask", "_Cull", "_ReceiveShadows", "_EnvironmentReflections", "_SpecularHighlights", "_GlossyReflections", "_QueueOffset",
        "_BaseMap", "_BumpMap", "_MetallicGlossMap", "_OcclusionMap", "_EmissionMap",
    ];

    private static readonly string[] Hdrp =
    [
        .. Both, "_SurfaceType", "_BlendMode", "_AlphaCutoffEnable", "_AlphaCutoff", "_AlphaSrcBlend", "_AlphaDstBlend", "_CullMode", "_CullModeForward", "_DoubleSidedEnable",
        "_DoubleSidedNormalMode", "_DoubleSidedConstants", "_MaterialID", "_MetallicRemapMin", "_MetallicRemapMax", "_SmoothnessRemapMin", "_SmoothnessRemapMax", "_AORemapMin",
        "_AORemapMax", "_NormalScale", "_NormalMapSpace", "_UseEmissiveIntensity", "_EmissiveExposureWeight", "_EmissiveColor", "_ZTestGBuffer", "_ZTestDepthEqualForOpaque",
        "_StencilRefDepth", "_StencilRefGBuffer", "_StencilRefMV", "_BaseColorMap", "_NormalMap", "_MaskMap", "_EmissiveColorMap",
    ];

    private RenderPipelines(RenderPipelineAsset? asset) => RenderPipelineManager.Change(asset!);

    /// <summary>Until it is disposed.  name: as the exporter's option has it.</summary>
    public static RenderPipelines Use(string name) => new(name switch
    {
        "urp" => new UniversalRenderPipelineAsset(),
        "hdrp" => new HDRenderPipelineAsset(),
        _ => null,
    });

    public void Dispose() => RenderPipelineManager.Change(null!);

    private sealed class UniversalRenderPipelineAsset : RenderPipelineAsset
    {
        public override Unity.Material defaultMaterial { get; } = new(Unity.Shader.Of("Universal Render Pipeline/Lit", Urp));
    }

    private sealed class HDRenderPipelineAsset : RenderPipelineAsset
    {
        public override Unity.Material defaultMaterial { get; } = new(Unity.Shader.Of("HDRP/Lit", Hdrp));
    }
}
