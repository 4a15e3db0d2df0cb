using System;
using System.Linq;
using Kinefab.Json;

namespace Kinefab.Document;

/// <summary>A scene as its text: the one that the exporter writes of it, byte for byte.</summary>
internal static class SceneText
{
    /// <summary>UTF-8 without byte order mark; of the version that what is in the scene needs, and no older than its own.</summary>
    /// <exception cref="ArgumentException">A number is not finite, an <c>ExtrasJson</c> no object, or a string no Unicode.</exception>
    internal static ReadOnlyMemory<byte> Of(SceneDocument document)
    {
        JsonWriter json = Written(document);

        // A buffer in the file itself is one of 1.1.
        int least = document.Buffers.Any(buffer => buffer.Uri is null) ? Math.Max(1, json.Minor) : json.Minor;
        string version = FormatVersion.AtLeast(document.Version, least);
        return version == document.Version ? json.Text : Written(document with { Version = version }).Text;
    }

    private static JsonWriter Written(SceneDocument document)
    {
        var json = new JsonWriter();
        document.Write(json);
        return json;
    }
}
