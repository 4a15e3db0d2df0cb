using System;
using System.Collections.Generic;
using System.IO;
using UnityEngine;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>
    /// The textures that materials show, one for each use of an image: colours are imported otherwise than numbers, and Unity wants metallic,
    /// occlusion and smoothness in one, with the material's own factors, which its shaders do not apply to a map.
    /// </summary>
    internal sealed class Textures
    {
        private static readonly string[] Endings = { ".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".psd", ".gif", ".exr", ".hdr", ".tga" };

        private readonly Doc.SceneDocument document;
        private readonly List<KinefabFinding> findings;
        private readonly HashSet<string> twins = new HashSet<string>();
        private readonly Dictionary<string, Texture2D> made = new Dictionary<string, Texture2D>();

        /// <param name="document">Whose images they are.</param>
        /// <param name="findings">Gets what Unity cannot read.</param>
        internal Textures(Doc.SceneDocument document, List<KinefabFinding> findings)
        {
            this.document = document;
            this.findings = findings;
            var named = new Dictionary<string, Doc.Image>();
            foreach (Doc.Image image in document.Images)
            {
                if (!named.TryGetValue(image.Name, out Doc.Image other))
                {
                    named[image.Name] = image;
                }
                else if (Held(image) != Held(other))
                {
                    twins.Add(image.Name);
                }
            }
        }

        /// <summary>By what they are in the source, which no order and no other image changes. Null: what Unity could not read.</summary>
        internal IReadOnlyDictionary<string, Texture2D> Made => made;

        /// <summary>An image of colours (sRGB), or of a normal map; null: there is none, or Unity cannot read it.</summary>
        /// <param name="from">Which image, and what lies beyond its edge.</param>
        /// <param name="isNormal">Whether it is a normal map.</param>
        /// <param name="slot">For the findings: "color".</param>
        /// <param name="material">For the findings.</param>
        internal Texture2D Plain(Doc.Texture from, bool isNormal, string slot, string material)
        {
            if (from == null)
            {
                return null;
            }

            Doc.Image image = document.Images[from.Image];
            string use = isNormal ? "normal" : "color";
            string held = twins.Contains(image.Name) ? "|" + Held(image) : "";
            string identity = $"{image.Name}{held}|{use}|{Word(from.Wrap)}";
            if (!made.TryGetValue(identity, out Texture2D texture))
            {
                texture = Read(image, isLinear: isNormal);
                if (texture != null)
                {
                    texture.name = isNormal ? Stem(image.Name) + " normal" : Stem(image.Name);
                    texture.wrapMode = (TextureWrapMode)from.Wrap;
                    if (isNormal)
                    {
                        FillAlpha(texture);
                    }
                }

                made[identity] = texture;
            }

            if (texture == null)
            {
                TellLost(image, slot, material);
            }

            return texture;
        }

        /// <summary>Metallic in red, occlusion in green, smoothness in alpha; null: the material has neither map, or Unity cannot read one.</summary>
        /// <param name="from">The material.</param>
        /// <param name="own">What the material is among all.</param>
        internal Texture2D Packed(Doc.Material from, string own)
        {
            Doc.Texture first = from.MetallicRoughnessTexture ?? from.OcclusionTexture;
            if (first == null)
            {
                return null;
            }

            Doc.Image image = document.Images[first.Image];
            string identity = $"{own}|mask|{image.Name}|{Word(first.Wrap)}";
            if (!made.TryGetValue(identity, out Texture2D texture))
            {
                Texture2D rough = Pixels(from.MetallicRoughnessTexture, from.Name), occluded = Pixels(from.OcclusionTexture, from.Name);
                bool isWhole = (rough != null || from.MetallicRoughnessTexture == null) && (occluded != null || from.OcclusionTexture == null);
                texture = isWhole ? Pack(from, rough, occluded) : null;
                UnityEngine.Object.DestroyImmediate(rough);
                UnityEngine.Object.DestroyImmediate(occluded);
                if (texture != null)
                {
                    texture.name = from.Name + " mask";
                    texture.wrapMode = (TextureWrapMode)first.Wrap;
                }

                made[identity] = texture;
            }

            return texture;
        }

        private static Texture2D Pack(Doc.Material from, Texture2D rough, Texture2D occluded)
        {
            Texture2D size = rough != null ? rough : occluded;
            var packed = new Texture2D(size.width, size.height, TextureFormat.RGBA32, mipChain: true, linear: true);
            Color32[] pixels = size.GetPixels32();
            byte[] occlusion = occluded == null ? null : Red(occluded, size.width, size.height);
            for (int i = 0; i < pixels.Length; i++)
            {
                Color32 pixel = pixels[i];
                pixels[i] = new Color32(
                    rough == null ? byte.MaxValue : (byte)Math.Round(from.Metallic * pixel.b),
                    occlusion == null ? byte.MaxValue : occlusion[i],
                    0,
                    rough == null ? byte.MaxValue : (byte)Math.Round(byte.MaxValue - (1 - from.Smoothness) * pixel.g));
            }

            packed.SetPixels32(pixels);
            packed.Apply(updateMipmaps: true);
            return packed;
        }

        // The red of an image in another size. Unity's rows begin at the bottom.
        private static byte[] Red(Texture2D from, int width, int height)
        {
            Color32[] pixels = from.GetPixels32();
            var red = new byte[pixels.Length];
            for (int i = 0; i < red.Length; i++)
            {
                red[i] = pixels[(from.height - 1 - i / from.width) * from.width + i % from.width].r;
            }

            byte[] resized = Resampling.Resized(red, from.width, from.height, width, height);
            for (int row = 0; row < height / 2; row++)
            {
                for (int x = 0; x < width; x++)
                {
                    int top = row * width + x, bottom = (height - 1 - row) * width + x;
                    (resized[top], resized[bottom]) = (resized[bottom], resized[top]);
                }
            }

            return resized;
        }

        // Shaders take a normal's x from red times alpha, so that they can read both of the forms that Unity packs normals in.
        private static void FillAlpha(Texture2D texture)
        {
            Color32[] pixels = texture.GetPixels32();
            bool isFull = true;
            for (int i = 0; i < pixels.Length; i++)
            {
                isFull &= pixels[i].a == byte.MaxValue;
                pixels[i].a = byte.MaxValue;
            }

            if (!isFull)
            {
                texture.SetPixels32(pixels);
                texture.Apply(updateMipmaps: true);
            }
        }

        private Texture2D Pixels(Doc.Texture from, string material)
        {
            if (from == null)
            {
                return null;
            }

            Texture2D texture = Read(document.Images[from.Image], isLinear: true);
            if (texture == null)
            {
                TellLost(document.Images[from.Image], "metallic, roughness or occlusion", material);
            }

            return texture;
        }

        private Texture2D Read(Doc.Image image, bool isLinear)
        {
            var texture = new Texture2D(2, 2, TextureFormat.RGBA32, mipChain: true, isLinear);
            if (texture.LoadImage(document.BytesOf(image).ToArray()))
            {
                return texture;
            }

            UnityEngine.Object.DestroyImmediate(texture);
            return null;
        }

        private void TellLost(Doc.Image image, string slot, string material) => findings.Add(KinefabFinding.Of(
            "TEXTURE_NOT_WRITTEN", $"{slot} texture of material {material}", ("texture", image.Name), ("detail", $"Unity reads no {image.MediaType} of this content")));

        private string Held(Doc.Image image) => Digest.Of(document.BytesOf(image));

        private static string Word(Doc.TextureWrap wrap) => wrap == Doc.TextureWrap.Repeat ? "repeat" : wrap == Doc.TextureWrap.Clamp ? "clamp" : "mirror";

        private static string Stem(string name)
        {
            string ending = Path.GetExtension(name).ToLowerInvariant();
            return Array.IndexOf(Endings, ending) < 0 ? name : name.Substring(0, name.Length - ending.Length);
        }
    }
}
