using System;
using System.Collections.Generic;
using Kinefab.Numerics;
using UnityEngine;
using UnityEngine.Rendering;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>Makes materials of the shader that the project's render pipeline calls its standard one, or of a template.</summary>
    internal sealed class Surfaces
    {
        private readonly Material template;
        private readonly List<KinefabFinding> findings;
        private Shader shader;
        private bool isLooked;

        /// <param name="document">Whose materials and images they are.</param>
        /// <param name="template">Copied for each surface; null: what the pipeline has.</param>
        /// <param name="findings">Gets what the project lacks, and what its shader has no place for.</param>
        internal Surfaces(Doc.SceneDocument document, Material template, List<KinefabFinding> findings)
        {
            Textures = new Textures(document, findings);
            this.template = template != null ? template : PipelineMaterial();
            this.findings = findings;
        }

        /// <summary>Those that the materials show.</summary>
        internal Textures Textures { get; }

        /// <summary>Null where the project has no shader for it: Unity then shows its own sign for that.</summary>
        /// <param name="from">The material.</param>
        /// <param name="own">What it is among all.</param>
        internal Material Make(Doc.Material from, string own)
        {
            Material material = Blank();
            if (material == null)
            {
                return null;
            }

            material.name = from.Name;
            var maps = new SurfaceMaps
            {
                Color = Textures.Plain(from.ColorTexture, isNormal: false, "color", from.Name),
                Normal = Textures.Plain(from.NormalTexture, isNormal: true, "normal", from.Name),
                Packed = Textures.Packed(from, own),

                // What shines not at all shows no map.
                Emission = from.Emission == Vector3d.Zero ? null : Textures.Plain(from.EmissionTexture, isNormal: false, "emission", from.Name),
            };
            SurfaceSheet.Fill(material, from, maps);
            TellLosses(material, from, maps);
            return material;
        }

        private void TellLosses(Material material, Doc.Material from, SurfaceMaps maps)
        {
            string owner = "material " + from.Name, shader = $"the shader {material.shader.name}";
            if (from.DoubleSided && !SurfaceSheet.CanBeDoubleSided(material))
            {
                string feature = "other side of " + owner;
                findings.Add(KinefabFinding.Of("LOOK_NOT_SHOWN", feature, ("feature", feature), ("shader", shader)));
            }

            Doc.Texture leading = SurfaceSheet.Leading(from, maps);
            Texture(maps.Color, from.ColorTexture, "color", isAlone: false);
            Texture(maps.Normal, from.NormalTexture, "normal", isAlone: false);
            Texture(maps.Packed, from.MetallicRoughnessTexture, "metallic and roughness", isAlone: false);
            Texture(maps.Packed, from.OcclusionTexture, "occlusion", isAlone: false);
            Texture(maps.Emission, from.EmissionTexture, "emission", isAlone: SurfaceSheet.IsHdrp(material));

            void Texture(Texture2D shown, Doc.Texture texture, string slot, bool isAlone)
            {
                if (shown == null || texture == null)
                {
                    return;
                }

                string feature = $"{slot} texture of {owner}";
                if (texture.UvSet != 0)
                {
                    Lost("uvSet", feature, shader);
                }

                if (texture.Rotation != 0)
                {
                    Lost("rotation", feature, shader);
                }

                if (!isAlone && (texture.Scale != leading.Scale || texture.Offset != leading.Offset))
                {
                    Lost("its own scale and offset", feature, shader);
                }
            }
        }

        private void Lost(string field, string feature, string target) =>
            findings.Add(KinefabFinding.Of("TARGET_FIELD_DROPPED", $"{field} of {feature}", ("target", target), ("field", field), ("feature", feature)));

        // Of the editor: in a build pipelines have none, and there a template is given.
        private static Material PipelineMaterial()
        {
            RenderPipelineAsset pipeline = GraphicsSettings.currentRenderPipeline;
            return pipeline == null ? null : pipeline.defaultMaterial;
        }

        private Material Blank()
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
    }
}
