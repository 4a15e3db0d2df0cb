using System;
using System.Collections.Generic;
using Kinefab.Numerics;
using UnityEngine;
using UnityEngine.Rendering;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>The textures of one material; null: none.</summary>
    internal struct SurfaceMaps
    {
        internal Texture2D Color;
        internal Texture2D Normal;

        /// <summary>Metallic in red, occlusion in green, smoothness in alpha.</summary>
        internal Texture2D Packed;
        internal Texture2D Emission;
    }

    /// <summary>
    /// What a material holds in the terms of the shader that a pipeline calls its standard one, Standard, URP Lit or HDRP Lit: the same as the exporter's
    /// prefabs have (materials.py). Which of the three it is, its properties tell, so that users' templates may be of shaders of their own.
    /// </summary>
    internal sealed class SurfaceSheet
    {
        private const int CutoutQueue = 2450, TransparentQueue = 3000;

        // Of what takes decals.
        private const int HdrpOpaqueQueue = 2225, HdrpCutoutQueue = 2475;

        private static readonly string[] AllKeywords =
        {
            "_ALPHATEST_ON", "_ALPHAPREMULTIPLY_ON", "_NORMALMAP", "_METALLICGLOSSMAP", "_METALLICSPECGLOSSMAP", "_OCCLUSIONMAP", "_EMISSION",
            "_SURFACE_TYPE_TRANSPARENT", "_DOUBLESIDED_ON", "_MASKMAP", "_EMISSIVE_COLOR_MAP", "_ENABLE_FOG_ON_TRANSPARENT",
        };

        private readonly Doc.Material from;
        private readonly SurfaceMaps maps;
        private readonly Material to;
        private readonly Doc.AlphaMode mode;
        private readonly bool shines;
        private readonly HashSet<string> keywords = new HashSet<string>();

        private SurfaceSheet(Doc.Material from, SurfaceMaps maps, Material to)
        {
            this.from = from;
            this.maps = maps;
            this.to = to;
            mode = from.AlphaMode ?? (from.Color.A < 1 ? Doc.AlphaMode.Blend : Doc.AlphaMode.Opaque);
            shines = from.Emission != Vector3d.Zero;
        }

        private bool IsBlended => mode == Doc.AlphaMode.Blend;

        private bool IsMasked => mode == Doc.AlphaMode.Mask;

        private bool HasMetallicMap => maps.Packed != null && from.MetallicRoughnessTexture != null;

        private bool HasOcclusionMap => maps.Packed != null && from.OcclusionTexture != null;

        /// <summary>Fills a material in.</summary>
        internal static void Fill(Material to, Doc.Material from, SurfaceMaps maps)
        {
            var sheet = new SurfaceSheet(from, maps, to);
            sheet.Common();
            if (IsHdrp(to))
            {
                sheet.Hdrp();
            }
            else
            {
                sheet.Builtin();
                if (to.HasProperty("_BaseColor"))
                {
                    sheet.Urp();
                }
            }

            sheet.SetKeywords();
        }

        /// <summary>Whether the shader places the map of emission by itself; all others it places as it places the colour.</summary>
        internal static bool IsHdrp(Material material) => material.HasProperty("_BaseColorMap");

        /// <summary>Whether it can be seen from behind at all: Standard has no such switch.</summary>
        internal static bool CanBeDoubleSided(Material material) => IsHdrp(material) || material.HasProperty("_Cull");

        private void Common()
        {
            // The file's colour is linear, a material's property is not; that of its own light is (HDR).
            Color color = new Color((float)from.Color.R, (float)from.Color.G, (float)from.Color.B, (float)from.Color.A).gamma;
            Set("_Color", color);
            Set("_BaseColor", color);
            Set("_EmissionColor", Light);
            Set("_Cutoff", from.AlphaCutoff);
            Set("_Metallic", from.Metallic);
            Set("_Glossiness", from.Smoothness);
            Set("_SrcBlend", (int)BlendMode.One);
            Set("_DstBlend", IsBlended ? (int)BlendMode.OneMinusSrcAlpha : (int)BlendMode.Zero);
            Set("_ZWrite", IsBlended ? 0 : 1);
            Set("_BumpScale", 1);
            to.renderQueue = IsBlended ? TransparentQueue : IsMasked ? CutoutQueue : -1;
            to.SetOverrideTag("RenderType", IsBlended ? "Transparent" : IsMasked ? "TransparentCutout" : "");
            to.doubleSidedGI = from.DoubleSided;
            to.globalIlluminationFlags = shines ? MaterialGlobalIlluminationFlags.BakedEmissive : MaterialGlobalIlluminationFlags.EmissiveIsBlack;
            Want("_ALPHATEST_ON", IsMasked);
            Want("_NORMALMAP", maps.Normal != null);
        }

        private Color Light => new Color((float)from.Emission.X, (float)from.Emission.Y, (float)from.Emission.Z, 1);

        private void Builtin()
        {
            Want("_ALPHAPREMULTIPLY_ON", IsBlended);
            Want("_METALLICGLOSSMAP", HasMetallicMap);
            Want("_EMISSION", shines);
            Set("_Mode", IsMasked ? 1 : IsBlended ? 3 : 0);
            Set("_GlossMapScale", 1);
            Set("_OcclusionStrength", 1);
            Set("_SmoothnessTextureChannel", 0);
            Set("_UVSec", 0);
            Map("_MainTex", maps.Color, from.ColorTexture);
            Map("_BumpMap", maps.Normal, from.NormalTexture);
            Map("_MetallicGlossMap", HasMetallicMap ? maps.Packed : null, Packed);
            Map("_OcclusionMap", HasOcclusionMap ? maps.Packed : null, Packed);
            Map("_EmissionMap", maps.Emission, from.EmissionTexture);
        }

        private void Urp()
        {
            // From where shaders keep what shines through glass undimmed, that tells them from how colours blend.
            bool keepsSpecular = to.HasProperty("_BlendModePreserveSpecular");
            Want("_METALLICGLOSSMAP", false);
            Want("_METALLICSPECGLOSSMAP", HasMetallicMap);
            Want("_OCCLUSIONMAP", HasOcclusionMap);
            Want("_SURFACE_TYPE_TRANSPARENT", IsBlended);
            foreach (string pass in new[] { "DepthOnly", "SHADOWCASTER" })
            {
                to.SetShaderPassEnabled(pass, !IsBlended);
            }

            if (!IsBlended && !IsMasked)
            {
                to.SetOverrideTag("RenderType", "Opaque");
            }

            Set("_WorkflowMode", 1);
            Set("_Surface", IsBlended ? 1 : 0);
            Set("_Blend", IsBlended && !keepsSpecular ? 1 : 0);
            Set("_BlendModePreserveSpecular", 1);
            Set("_SrcBlendAlpha", (int)BlendMode.One);
            Set("_DstBlendAlpha", IsBlended ? (int)BlendMode.OneMinusSrcAlpha : (int)BlendMode.Zero);
            Set("_AlphaClip", IsMasked ? 1 : 0);
            Set("_AlphaToMask", IsMasked ? 1 : 0);
            Set("_Cull", from.DoubleSided ? 0 : 2);
            Set("_Smoothness", HasMetallicMap ? 1 : from.Smoothness);
            Map("_BaseMap", maps.Color, from.ColorTexture);
        }

        private void Hdrp()
        {
            foreach (string pass in new[] { "TransparentDepthPrepass", "TransparentDepthPostpass", "TransparentBackface", "RayTracingPrepass", "MOTIONVECTORS" })
            {
                to.SetShaderPassEnabled(pass, false);
            }

            if (!IsBlended)
            {
                to.renderQueue = IsMasked ? HdrpCutoutQueue : HdrpOpaqueQueue;
            }

            Want("_DISABLE_SSR_TRANSPARENT", true);
            Want("_NORMALMAP_TANGENT_SPACE", true);
            Want("_SURFACE_TYPE_TRANSPARENT", IsBlended);
            Want("_ENABLE_FOG_ON_TRANSPARENT", IsBlended);
            Want("_DOUBLESIDED_ON", from.DoubleSided);
            Want("_MASKMAP", maps.Packed != null);
            Want("_EMISSIVE_COLOR_MAP", maps.Emission != null);
            Set("_SurfaceType", IsBlended ? 1 : 0);
            Set("_BlendMode", 0);
            Set("_AlphaCutoffEnable", IsMasked ? 1 : 0);
            Set("_AlphaCutoff", from.AlphaCutoff);
            Set("_AlphaSrcBlend", (int)BlendMode.One);
            Set("_AlphaDstBlend", IsBlended ? (int)BlendMode.OneMinusSrcAlpha : (int)BlendMode.Zero);
            Set("_CullMode", from.DoubleSided ? 0 : 2);
            Set("_CullModeForward", from.DoubleSided ? 0 : 2);
            Set("_DoubleSidedEnable", from.DoubleSided ? 1 : 0);
            Set("_DoubleSidedNormalMode", 1);
            Set("_DoubleSidedConstants", new Color(1, 1, -1, 0));
            Set("_MaterialID", 1);
            Set("_Metallic", HasMetallicMap ? 1 : from.Metallic);
            Set("_MetallicRemapMin", HasMetallicMap ? 0 : from.Metallic);
            Set("_MetallicRemapMax", HasMetallicMap ? 1 : from.Metallic);
            Set("_Smoothness", from.Smoothness);
            Set("_SmoothnessRemapMin", HasMetallicMap ? 0 : from.Smoothness);
            Set("_SmoothnessRemapMax", HasMetallicMap ? 1 : from.Smoothness);
            Set("_AORemapMin", 0);
            Set("_AORemapMax", 1);
            Set("_NormalScale", 1);
            Set("_NormalMapSpace", 0);
            Set("_UseEmissiveIntensity", 0);
            Set("_EmissiveExposureWeight", 1);
            Set("_EmissiveColor", Light);
            Set("_ZTestGBuffer", IsMasked ? 3 : 4);
            Set("_ZTestDepthEqualForOpaque", IsBlended ? 4 : 3);
            Set("_StencilRefDepth", IsBlended ? 0 : 8);
            Set("_StencilRefGBuffer", IsBlended ? 2 : 10);
            Set("_StencilRefMV", IsBlended ? 32 : 40);
            Map("_BaseColorMap", maps.Color, from.ColorTexture);
            Map("_MainTex", maps.Color, from.ColorTexture);
            Map("_NormalMap", maps.Normal, from.NormalTexture);
            Map("_MaskMap", maps.Packed, Packed);
            Map("_EmissiveColorMap", maps.Emission, from.EmissionTexture);
        }

        private Doc.Texture Packed => from.MetallicRoughnessTexture ?? from.OcclusionTexture;

        /// <summary>The texture whose scale and offset the shaders give to every map: the colour's, else that of the first map that is there.</summary>
        internal static Doc.Texture Leading(Doc.Material from, SurfaceMaps maps) =>
            maps.Color != null ? from.ColorTexture
            : maps.Normal != null ? from.NormalTexture
            : maps.Packed != null ? from.MetallicRoughnessTexture ?? from.OcclusionTexture
            : maps.Emission != null ? from.EmissionTexture : null;

        private void Map(string property, Texture2D texture, Doc.Texture place)
        {
            if (!to.HasProperty(property))
            {
                return;
            }

            to.SetTexture(property, texture);
            bool leads = property == "_MainTex" || property == "_BaseMap" || property == "_BaseColorMap";
            place = leads ? Leading(from, maps) : texture == null ? null : place;
            to.SetTextureScale(property, place == null ? Vector2.one : Numbers.Vector(place.Scale));
            to.SetTextureOffset(property, place == null ? Vector2.zero : Numbers.Vector(place.Offset));
        }

        private void Want(string keyword, bool isOn)
        {
            if (isOn)
            {
                keywords.Add(keyword);
            }
            else
            {
                keywords.Remove(keyword);
            }
        }

        // Also off: what a template has on for its own maps would look for maps that are not there.
        private void SetKeywords()
        {
            foreach (string keyword in AllKeywords)
            {
                if (!keywords.Contains(keyword))
                {
                    to.DisableKeyword(keyword);
                }
            }

            foreach (string keyword in keywords)
            {
                to.EnableKeyword(keyword);
            }
        }

        private void Set(string property, Color value)
        {
            if (to.HasProperty(property))
            {
                to.SetColor(property, value);
            }
        }

        private void Set(string property, double value)
        {
            if (to.HasProperty(property))
            {
                to.SetFloat(property, (float)value);
            }
        }
    }
}
