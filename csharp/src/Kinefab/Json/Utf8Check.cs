using System;
using System.Text;

namespace Kinefab.Json;

/// <summary>Whether bytes are UTF-8.</summary>
internal static class Utf8Check
{
    /// <summary>Offset of the first byte that is not, or -1.</summary>
    internal static int FirstInvalid(ReadOnlySpan<byte> text)
    {
#if NET8_0_OR_GREATER
        if (System.Text.Unicode.Utf8.IsValid(text))
            return -1;
#endif
        try
        {
            new UTF8Encoding(false, throwOnInvalidBytes: true).GetCharCount(text);
            return -1;
        }
        catch (DecoderFallbackException fault)
        {
            return Math.Max(0, fault.Index);
        }
    }
}
