using System;

namespace UnityEngine
{
    public enum TextureWrapMode
    {
        Repeat = 0,
        Clamp = 1,
        Mirror = 2,
    }

    public enum TextureFormat
    {
        RGB24 = 3,
        RGBA32 = 4,
    }

    public class Texture : Object
    {
        public TextureWrapMode wrapMode { get; set; }
    }

    public sealed class Texture2D : Texture
    {
        private Color32[] _pixels;

        public Texture2D(int width, int height, TextureFormat textureFormat, bool mipChain, bool linear)
        {
            (this.width, this.height, IsLinear, HasMipmaps) = (width, height, linear, mipChain);
            _pixels = new Color32[width * height];
        }

        public int width { get; private set; }

        public int height { get; private set; }

        public bool isReadable { get; private set; } = true;

        internal bool IsLinear { get; }

        internal bool HasMipmaps { get; }

        /// <summary>Whether the pixels that were set last reached the picture that is shown.</summary>
        internal bool IsApplied { get; private set; }

        public Color32[] GetPixels32() => isReadable ? (Color32[])_pixels.Clone() : throw new UnityException("Texture is not readable.");

        public void SetPixels32(Color32[] colors)
        {
            if (colors.Length != width * height)
            {
                throw new UnityException("Not as many as pixels.");
            }

            _pixels = (Color32[])colors.Clone();
            IsApplied = false;
        }

        public void Apply(bool updateMipmaps = true, bool makeNoLongerReadable = false)
        {
            IsApplied = true;
            isReadable &= !makeNoLongerReadable;
        }

        // Between the middles of pixels, repeated at the edges.
        public Color GetPixelBilinear(float u, float v)
        {
            double x = u * width - 0.5, y = v * height - 0.5;
            int left = (int)Math.Floor(x), low = (int)Math.Floor(y);
            double a = x - left, b = y - low;
            Color Mixed(Color32 p, Color32 q, double t) => new Color(
                (float)((p.r * (1 - t) + q.r * t) / 255), (float)((p.g * (1 - t) + q.g * t) / 255), (float)((p.b * (1 - t) + q.b * t) / 255), (float)((p.a * (1 - t) + q.a * t) / 255));
            return Color.Lerp(Mixed(At(left, low), At(left + 1, low), a), Mixed(At(left, low + 1), At(left + 1, low + 1), a), (float)b);
        }

        internal void Resize(int newWidth, int newHeight, Color32[] pixels)
        {
            (width, height, _pixels) = (newWidth, newHeight, pixels);
            IsApplied = true;
        }

        private Color32 At(int x, int y) => _pixels[(y % height + height) % height * width + (x % width + width) % width];
    }

    public static class ImageConversion
    {
        /// <summary>PNG pixel by pixel; a JPEG by its size alone, grey; nothing else.</summary>
        public static bool LoadImage(this Texture2D tex, byte[] data)
        {
            if (Png.TryRead(data, out int width, out int height, out Color32[] pixels) || Png.TryMeasureJpeg(data, out width, out height, out pixels))
            {
                tex.Resize(width, height, pixels);
                return true;
            }

            tex.Resize(8, 8, new Color32[64]); // Unity leaves its own sign for it
            return false;
        }
    }

    public struct Color32
    {
        public byte r, g, b, a;

        public Color32(byte r, byte g, byte b, byte a) => (this.r, this.g, this.b, this.a) = (r, g, b, a);

        public static implicit operator Color32(Color c) => new Color32(Byte(c.r), Byte(c.g), Byte(c.b), Byte(c.a));

        private static byte Byte(float share) => (byte)Math.Round(Math.Min(1, Math.Max(0, share)) * 255);
    }
}
