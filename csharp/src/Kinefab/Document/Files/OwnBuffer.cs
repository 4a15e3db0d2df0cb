using System;
using System.Collections.Generic;
using System.Linq;

namespace Kinefab.Document;

/// <summary>The buffer of a scene that lies in the scene's file: the one without a uri.</summary>
internal static class OwnBuffer
{
    /// <summary>Gives the buffer its bytes, without the padding behind them, or says why it has none.</summary>
    /// <param name="document">As read.</param>
    /// <param name="chunk">With its padding; null: the file has none.</param>
    internal static void Attach(SceneDocument document, ReadOnlyMemory<byte>? chunk)
    {
        string fault = "the file holds none";
        foreach (SceneBuffer buffer in document.Buffers.Where(buffer => buffer.Uri is null))
        {
            if (chunk is not { } bytes)
                buffer.Attach(null, fault);
            else if (buffer.ByteLength <= bytes.Length && bytes.Length - buffer.ByteLength < 4)
                buffer.Attach(bytes.Slice(0, (int)buffer.ByteLength));
            else
                buffer.Attach(null, null, bytes.Length);
            chunk = null;
            fault = "another one without a uri stands before it";
        }
    }

    /// <summary>The buffers as a binary file states them, the first with data as its own, and that data.</summary>
    internal static (IReadOnlyList<SceneBuffer> Buffers, ReadOnlyMemory<byte>? Data) Split(IReadOnlyList<SceneBuffer> buffers)
    {
        int own = 0;
        while (own < buffers.Count && buffers[own].Data is null)
            own++;
        if (own == buffers.Count)
            return (buffers, null);
        SceneBuffer[] stated = buffers.ToArray();
        stated[own] = stated[own].Stated() with { Uri = null };
        return (stated, stated[own].Data);
    }
}
