using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>Makes materials of the shader that the project's render pipeline calls its standard one, or of a template.</summary>
    internal sealed class Surfaces
    {
        private const int TransparentQueue = 3000;
        private readonly Material template;
        private readonly List<KinefabFinding> findings;
        private Shader shader;
        private bool isLooked;

        /// <param name="template">Copied for each surface; null: what the pipeline has.</param>
        /// <param name="findings">Gets what the project lacks.</param>
        internal Surfaces(Material template, List<KinefabFinding> findings)
        {
            this.template = template != null ? template : PipelineMaterial();
            this.findings = findings;
        }

        /// <summary>Null where the project has no shader for it: Unity then shows its own sign for that.</summary>
        internal Material Make(Doc.Material from)
        {
            Material material = Blank(from.Name);
            if (material == null)
            {
                return null;
            }

            material.name = from.Name;

            // The file's colour is linear, a material's property is not.
            Color color = new Color((float)from.Color.R, (float)from.Color.G, (float)from.Color.B, (float)from.Color.A).gamma;
            foreach (string property in new[] { "_Color", "_BaseColor" })
            {
                if (material.HasProperty(property))
                {
                    material.SetColor(property, color);
                }
            }

            Set(material, "_Metallic", from.Metallic);
            Set(material, "_Glossiness", from.Smoothness); // Standard
            Set(material, "_Smoothness", from.Smoothness); // URP and HDRP Lit
            if (from.Color.A < 1)
            {
                Blend(material);
            }

            return material;
        }

        // Of the editor: in a build pipelines have none, and there a template is given.
        private static Material PipelineMaterial()
        {
            RenderPipelineAsset pipeline = GraphicsSettings.currentRenderPipeline;
            return pipeline == null ? null : pipeline.defaultMaterial;
        }

        private Material Blank(string name)
        {
            if (template != null)
            {
                return new Material(template);
            }

            if (!isLooked)
            {
                isLooked = true;
                shader = Find(GraphicsSettings.currentRenderPipeline, out string wanted);
                if (shader == null)
                {
                    findings.Add(KinefabFinding.Of("UNITY_SHADER_MISSING", "/materials", ("shader", wanted)));
                }
            }

            return shader == null ? null : new Material(shader);
        }

        // By the name of the pipeline's class: the package refers to no pipeline.
        private static Shader Find(RenderPipelineAsset pipeline, out string wanted)
        {
            string kind = pipeline == null ? "" : pipeline.GetType().Name;
            wanted = kind.IndexOf("Universal", StringComparison.Ordinal) >= 0 ? "Universal Render Pipeline/Lit"
                : kind.IndexOf("HD", StringComparison.Ordinal) >= 0 ? "HDRP/Lit" : "Standard";
            Shader own = pipeline == null ? null : pipeline.defaultShader;
            return own != null ? own : Shader.Find(wanted);
        }

        // Standard's Transparent, and Transparent with premultiplied colours of URP's and HDRP's Lit.
        private static void Blend(Material material)
        {
            Set(material, "_Mode", 3);
            Set(material, "_Surface", 1);
            Set(material, "_SurfaceType", 1);
            Set(material, "_SrcBlend", (int)BlendMode.One);
            Set(material, "_DstBlend", (int)BlendMode.OneMinusSrcAlpha);
            Set(material, "_AlphaSrcBlend", (int)BlendMode.One);
            Set(material, "_AlphaDstBlend", (int)BlendMode.OneMinusSrcAlpha);
            Set(material, "_ZWrite", 0);
            material.SetOverrideTag("RenderType", "Transparent");
            material.EnableKeyword(material.HasProperty("_Mode") ? "_ALPHAPREMULTIPLY_ON" : "_SURFACE_TYPE_TRANSPARENT");
            material.renderQueue = TransparentQueue;
        }

        private static void Set(Material material, string property, double value)
        {
            if (material.HasProperty(property))
            {
                material.SetFloat(property, (float)value);
            }
        }
    }
}
