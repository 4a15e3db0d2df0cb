// What the library uses of netstandard2.1 and netstandard2.0 lacks, with the same behaviour.
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Security.Cryptography;
using System.Text;

namespace System
{
    internal readonly struct Index(int value, bool fromEnd = false)
    {
        public int GetOffset(int length) => fromEnd ? length - value : value;

        public static implicit operator Index(int value) => new(value);
    }

    internal readonly struct Range(Index start, Index end)
    {
        public Index Start { get; } = start;

        public Index End { get; } = end;
    }

    internal static class HashCode
    {
        public static int Combine<T1, T2, T3>(T1 a, T2 b, T3 c) => (a, b, c).GetHashCode();

        public static int Combine<T1, T2, T3, T4>(T1 a, T2 b, T3 c, T4 d) => (a, b, c, d).GetHashCode();
    }

    internal static class NetStandard20
    {
        extension(Array)
        {
            public static void Fill<T>(T[] array, T value)
            {
                for (int i = 0; i < array.Length; i++)
                    array[i] = value;
            }
        }

        extension(Enum)
        {
            public static T Parse<T>(string name, bool ignoreCase)
                where T : struct => Enum.TryParse(name, ignoreCase, out T value) ? value : throw new ArgumentException(name);
        }

        public static string Replace(this string text, string from, string to, StringComparison comparison) =>
            comparison == StringComparison.Ordinal ? text.Replace(from, to) : throw new NotSupportedException();

        public static bool Contains(this string text, char value) => text.IndexOf(value) >= 0;

        public static void Write(this Stream stream, ReadOnlySpan<byte> bytes) => stream.Write(bytes.ToArray(), 0, bytes.Length);

        public static string GetString(this Encoding encoding, ReadOnlySpan<byte> bytes) => encoding.GetString(bytes.ToArray());

        public static int GetCharCount(this Encoding encoding, ReadOnlySpan<byte> bytes) => encoding.GetCharCount(bytes.ToArray());

        public static bool TryAdd<TKey, TValue>(this Dictionary<TKey, TValue> dictionary, TKey key, TValue value)
            where TKey : notnull
        {
            if (dictionary.ContainsKey(key))
                return false;
            dictionary.Add(key, value);
            return true;
        }

        public static void Deconstruct<TKey, TValue>(this KeyValuePair<TKey, TValue> pair, out TKey key, out TValue value) =>
            (key, value) = (pair.Key, pair.Value);

        public static bool TryComputeHash(this HashAlgorithm algorithm, ReadOnlySpan<byte> source, Span<byte> destination, out int written)
        {
            byte[] hash = algorithm.ComputeHash(source.ToArray());
            hash.CopyTo(destination);
            written = hash.Length;
            return true;
        }
    }
}

namespace System.Diagnostics.CodeAnalysis
{
    [AttributeUsage(AttributeTargets.Parameter)]
    internal sealed class MaybeNullWhenAttribute(bool returnValue) : Attribute
    {
        public bool ReturnValue { get; } = returnValue;
    }
}
