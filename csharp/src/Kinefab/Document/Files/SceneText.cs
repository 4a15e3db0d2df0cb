using System;
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
        string version = FormatVersion.AtLeast(document.Version, json.Minor);
        return version == document.Version ? json.Text : Written(document with { Version = version }).Text;
    }

    private static JsonWriter Written(SceneDocument document)
    {
        var json = new JsonWriter();
        document.Write(json);
        return json;
    }
}
