using System;
using System.Collections.Generic;
using UnityEngine.Rendering;

namespace UnityEngine
{
    public sealed class Shader : Object
    {
        /// <summary>The shaders of the project, by name; a build has only those that it was made with.</summary>
        internal static readonly Dictionary<string, Shader> Known = new Dictionary<string, Shader>
        {
            ["Standard"] = Of(
                "Standard", "_Color", "_MainTex", "_Cutoff", "_Glossiness", "_GlossMapScale", "_SmoothnessTextureChannel", "_Metallic", "_MetallicGlossMap", "_SpecularHighlights",
                "_GlossyReflections", "_BumpScale", "_BumpMap", "_OcclusionStrength", "_OcclusionMap", "_EmissionColor", "_EmissionMap", "_UVSec", "_Mode", "_SrcBlend", "_DstBlend", "_ZWrite"),
        };

        internal string[] Properties = Array.Empty<string>();

        public static Shader Find(string name) => Known.TryGetValue(name, out Shader found) ? found : null;

        internal static Shader Of(string name, params string[] properties) => new Shader { name = name, Properties = properties };
    }

    public sealed class Material : Object
    {
        private readonly Dictionary<string, object> _values = new Dictionary<string, object>();
        private readonly HashSet<string> _keywords = new HashSet<string>();

        public Material(Shader shader) => this.shader = shader ?? throw new ArgumentNullException(nameof(shader));

        public Material(Material source)
            : this(source.shader)
        {
            foreach (KeyValuePair<string, object> value in source._values)
            {
                _values[value.Key] = value.Value;
            }

            _keywords.UnionWith(source._keywords);
            renderQueue = source.renderQueue;
            doubleSidedGI = source.doubleSidedGI;
            globalIlluminationFlags = source.globalIlluminationFlags;
        }

        public Shader shader { get; set; }

        /// <summary>Of the property that the shader calls its main colour.</summary>
        public Color color
        {
            get => GetColor(HasProperty("_BaseColor") ? "_BaseColor" : "_Color");
            set => SetColor(HasProperty("_BaseColor") ? "_BaseColor" : "_Color", value);
        }

        public int renderQueue { get; set; } = -1;

        public bool doubleSidedGI { get; set; }

        public MaterialGlobalIlluminationFlags globalIlluminationFlags { get; set; } = MaterialGlobalIlluminationFlags.EmissiveIsBlack;

        public bool enableInstancing { get; set; }

        public string[] shaderKeywords
        {
            get
            {
                var all = new string[_keywords.Count];
                _keywords.CopyTo(all);
                Array.Sort(all, StringComparer.Ordinal);
                return all;
            }
        }

        public bool HasProperty(string name) => Array.IndexOf(shader.Properties, name) >= 0;

        public void SetFloat(string name, float value) => _values[name] = value;

        public float GetFloat(string name) => _values.TryGetValue(name, out object value) ? (float)value : 0;

        public void SetColor(string name, Color value) => _values[name] = value;

        public Color GetColor(string name) => _values.TryGetValue(name, out object value) ? (Color)value : Color.white;

        public void SetTexture(string name, Texture value) => _values[name] = value;

        public Texture GetTexture(string name) => _values.TryGetValue(name, out object value) ? (Texture)value : null;

        public void SetTextureScale(string name, Vector2 value) => _values["scale " + name] = value;

        public Vector2 GetTextureScale(string name) => _values.TryGetValue("scale " + name, out object value) ? (Vector2)value : Vector2.one;

        public void SetTextureOffset(string name, Vector2 value) => _values["offset " + name] = value;

        public Vector2 GetTextureOffset(string name) => _values.TryGetValue("offset " + name, out object value) ? (Vector2)value : Vector2.zero;

        public string GetTag(string tag, bool searchFallbacks) => _values.TryGetValue("tag " + tag, out object value) ? (string)value : "";

        public bool GetShaderPassEnabled(string passName) => !_values.TryGetValue("pass " + passName, out object value) || (bool)value;

        public void EnableKeyword(string keyword) => _keywords.Add(keyword);

        public void DisableKeyword(string keyword) => _keywords.Remove(keyword);

        public bool IsKeywordEnabled(string keyword) => _keywords.Contains(keyword);

        public void SetOverrideTag(string tag, string value) => _values["tag " + tag] = value;

        public void SetShaderPassEnabled(string passName, bool enabled) => _values["pass " + passName] = enabled;
    }
}

namespace UnityEngine
{
    [Flags]
    public enum MaterialGlobalIlluminationFlags
    {
        None = 0,
        RealtimeEmissive = 1,
        BakedEmissive = 2,
        EmissiveIsBlack = 4,
    }
}

namespace UnityEngine.Rendering
{
    public enum BlendMode
    {
        Zero = 0,
        One = 1,
        OneMinusSrcAlpha = 10,
    }

    public abstract class RenderPipelineAsset : ScriptableObject
    {
        public virtual Material defaultMaterial => null;

        public virtual Shader defaultShader => null;
    }

    public static class RenderPipelineManager
    {
        public static event Action activeRenderPipelineTypeChanged;

        internal static void Change(RenderPipelineAsset to)
        {
            GraphicsSettings.Current = to;
            activeRenderPipelineTypeChanged?.Invoke();
        }
    }

    public sealed class GraphicsSettings : Object
    {
        internal static RenderPipelineAsset Current;

        public static RenderPipelineAsset currentRenderPipeline => Current;
    }
}
