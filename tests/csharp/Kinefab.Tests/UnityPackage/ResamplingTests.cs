using System.Linq;
using KinefabUnity;
using NUnit.Framework;

namespace Kinefab.Tests.UnityPackage;

/// <summary>Images in another size, to the bit as Pillow's <c>Image.resize</c> makes them for the exporter's prefabs (9.4, of the same 7 by 5 numbers).</summary>
public sealed class ResamplingTests
{
    private const int Width = 7, Height = 5;

    private static readonly byte[] Source = [.. Enumerable.Range(0, Width * Height).Select(i => (byte)(7 * i * i + 13 * i + i % 5 * 41))];

    private static readonly object[] Sizes =
    [
        new object[] { 3, 2, new[] { 110, 106, 161, 114, 94, 202 } },
        new object[] { 7, 2, new[] { 45, 149, 140, 114, 39, 205, 176, 104, 140, 82, 66, 136, 214, 214 } },
        new object[]
        {
            12, 5,
            new[]
            {
                0, 17, 58, 100, 148, 216, 188, 77, 144, 240, 162, 105, 0, 59, 161, 127, 75, 68, 41, 1, 101, 225, 213, 193, 178, 198, 232, 255, 230, 76, 14, 57, 86, 126, 207, 253, 65, 111,
                172, 90, 33, 125, 145, 91, 162, 248, 194, 153, 92, 68, 29, 30, 30, 0, 60, 222, 255, 239, 246, 251,
            },
        },
        new object[]
        {
            11, 9,
            new[]
            {
                0, 17, 59, 115, 187, 238, 123, 107, 237, 173, 99, 0, 31, 91, 106, 145, 181, 84, 88, 232, 188, 128, 0, 64, 153, 98, 74, 76, 16, 56, 217, 216, 184, 83, 138, 206, 179, 113, 26,
                10, 58, 161, 211, 230, 178, 203, 238, 255, 173, 22, 37, 78, 114, 196, 253, 122, 168, 211, 151, 119, 107, 75, 97, 181, 197, 193, 63, 114, 153, 45, 54, 150, 114, 137, 246, 208,
                157, 80, 76, 62, 32, 24, 50, 149, 221, 245, 234, 221, 93, 57, 15, 31, 10, 0, 166, 255, 240, 248, 255,
            },
        },
    ];

    [TestCaseSource(nameof(Sizes))]
    public void Resized_ToASize_IsPillowsToTheBit(int width, int height, int[] expected) =>
        Assert.That(Resampling.Resized(Source, Width, Height, width, height).Select(b => (int)b), Is.EqualTo(expected));

    [Test]
    public void Resized_ToItsOwnSize_IsItself() => Assert.That(Resampling.Resized(Source, Width, Height, Width, Height), Is.SameAs(Source));
}
