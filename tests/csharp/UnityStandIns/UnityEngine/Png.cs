using System;
using System.IO;
using System.IO.Compression;
using System.Text;

namespace UnityEngine
{
    /// <summary>As much of PNG as the tests' images need: not interlaced, 8 or 16 bits a channel, grey, colours or a palette, with alpha or without.</summary>
    internal static class Png
    {
        internal static bool TryRead(byte[] data, out int width, out int height, out Color32[] pixels)
        {
            (width, height, pixels) = (0, 0, null);
            try
            {
                if (data.Length < 8 || data[0] != 0x89 || data[1] != (byte)'P')
                {
                    return false;
                }

                int depth = 0, kind = 0;
                byte[] palette = Array.Empty<byte>(), clear = Array.Empty<byte>();
                using var packed = new MemoryStream();
                for (int at = 8; at + 12 <= data.Length;)
                {
                    int length = Int(data, at);
                    string name = Encoding.ASCII.GetString(data, at + 4, 4);
                    ReadOnlySpan<byte> body = data.AsSpan(at + 8, length);
                    switch (name)
                    {
                        case "IHDR":
                            (width, height, depth, kind) = (Int(data, at + 8), Int(data, at + 12), body[8], body[9]);
                            break;
                        case "PLTE":
                            palette = body.ToArray();
                            break;
                        case "tRNS":
                            clear = body.ToArray();
                            break;
                        case "IDAT":
                            packed.Write(data, at + 8, length);
                            break;
                    }

                    at += 12 + length;
                }

                packed.Position = 2; // the head of zlib
                using var unpacked = new MemoryStream();
                using (var inflate = new DeflateStream(packed, CompressionMode.Decompress))
                {
                    inflate.CopyTo(unpacked);
                }

                pixels = Pixels(unpacked.ToArray(), width, height, depth, kind, palette, clear);
                return true;
            }
            catch (Exception fault) when (fault is InvalidDataException || fault is ArgumentException || fault is IndexOutOfRangeException)
            {
                return false;
            }
        }

        internal static bool TryMeasureJpeg(byte[] data, out int width, out int height, out Color32[] pixels)
        {
            (width, height, pixels) = (0, 0, null);
            for (int at = 2; data.Length > 2 && data[0] == 0xFF && data[1] == 0xD8 && at + 9 < data.Length;)
            {
                if (data[at] != 0xFF)
                {
                    return false;
                }

                if (data[at + 1] >= 0xC0 && data[at + 1] <= 0xC3)
                {
                    (height, width) = (data[at + 5] << 8 | data[at + 6], data[at + 7] << 8 | data[at + 8]);
                    pixels = new Color32[width * height];
                    Array.Fill(pixels, new Color32(128, 128, 128, 255));
                    return true;
                }

                at += 2 + (data[at + 2] << 8 | data[at + 3]);
            }

            return false;
        }

        private static Color32[] Pixels(byte[] raw, int width, int height, int depth, int kind, byte[] palette, byte[] clear)
        {
            int channels = kind == 2 ? 3 : kind == 4 ? 2 : kind == 6 ? 4 : 1, step = channels * depth / 8, stride = width * step;
            if (depth != 8 && depth != 16)
            {
                throw new ArgumentException("not of these depths");
            }

            var rows = new byte[height][];
            for (int y = 0; y < height; y++)
            {
                rows[y] = Unfiltered(raw, y * (stride + 1), stride, step, y > 0 ? rows[y - 1] : new byte[stride]);
            }

            var pixels = new Color32[width * height];
            for (int y = 0; y < height; y++)
            {
                for (int x = 0; x < width; x++)
                {
                    byte Of(int channel) => rows[y][x * step + channel * depth / 8];
                    int entry = 3 * Of(0);
                    Color32 pixel = kind switch
                    {
                        0 => new Color32(Of(0), Of(0), Of(0), 255),
                        2 => new Color32(Of(0), Of(1), Of(2), 255),
                        3 => new Color32(palette[entry], palette[entry + 1], palette[entry + 2], Of(0) < clear.Length ? clear[Of(0)] : (byte)255),
                        4 => new Color32(Of(0), Of(0), Of(0), Of(1)),
                        _ => new Color32(Of(0), Of(1), Of(2), Of(3)),
                    };
                    pixels[(height - 1 - y) * width + x] = pixel; // Unity's lowest row comes first
                }
            }

            return pixels;
        }

        private static byte[] Unfiltered(byte[] raw, int at, int stride, int step, byte[] above)
        {
            var row = new byte[stride];
            for (int i = 0; i < stride; i++)
            {
                int left = i < step ? 0 : row[i - step], corner = i < step ? 0 : above[i - step], up = above[i];
                int guess = raw[at] switch
                {
                    1 => left,
                    2 => up,
                    3 => (left + up) / 2,
                    4 => Paeth(left, up, corner),
                    _ => 0,
                };
                row[i] = (byte)(raw[at + 1 + i] + guess);
            }

            return row;
        }

        private static int Paeth(int left, int up, int corner)
        {
            int p = left + up - corner, a = Math.Abs(p - left), b = Math.Abs(p - up), c = Math.Abs(p - corner);
            return a <= b && a <= c ? left : b <= c ? up : corner;
        }

        private static int Int(byte[] data, int at) => data[at] << 24 | data[at + 1] << 16 | data[at + 2] << 8 | data[at + 3];
    }
}
