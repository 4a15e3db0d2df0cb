using System;

namespace Kinefab.Json;

/// <summary>A text is no JSON from some place on; never leaves the library.</summary>
internal sealed class JsonSyntaxException : Exception
{
    /// <summary>A fault.</summary>
    /// <param name="offset">Of the byte that does not fit, or the text's length.</param>
    /// <param name="message">What is wrong there, without a stop.</param>
    /// <param name="isTooDeep">Whether a container was opened inside as many others as are allowed.</param>
    internal JsonSyntaxException(int offset, string message, bool isTooDeep = false)
        : base(message)
    {
        Offset = offset;
        IsTooDeep = isTooDeep;
    }

    internal int Offset { get; }

    internal bool IsTooDeep { get; }
}
