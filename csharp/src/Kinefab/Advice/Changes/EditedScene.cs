using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json;
using System.Text.Json.Nodes;
using Kinefab.Document;
using Kinefab.Validation;

namespace Kinefab.Advice.Changes;

/// <summary>Makes changes in a scene's text and reads it anew: the way that a user's own edit goes.</summary>
internal static class EditedScene
{
    /// <summary>The scene with the edits made; null when it is not valid with them.</summary>
    public static ValidScene? Apply(ValidScene scene, IEnumerable<SceneEdit> edits)
    {
        JsonNode root = Parse(scene);
        foreach (SceneEdit edit in edits)
            Set(root, edit.Pointer.Split('/').Skip(1).ToArray(), JsonNode.Parse(edit.Value)!);
        using var bytes = new MemoryStream();
        using (var json = new Utf8JsonWriter(bytes))
            root.WriteTo(json);
        Dictionary<string, ReadOnlyMemory<byte>?> buffers = scene.Document.Buffers.ToDictionary(b => b.Uri, b => b.Data);
        SceneReading reading = SceneFile.Parse(bytes.ToArray(), uri => buffers.TryGetValue(uri, out ReadOnlyMemory<byte>? data) ? data : null);
        return reading.Document is null ? null : SceneValidator.Validate(reading.Document).Scene;
    }

    /// <summary>A component as the file has it.</summary>
    public static JsonObject Component(ValidScene scene, int gameObject, int component) =>
        (JsonObject)Parse(scene)["gameObjects"]![gameObject]!["components"]![component]!.DeepClone();

    private static JsonNode Parse(ValidScene scene) =>
        JsonNode.Parse(scene.Document.Text.Span, documentOptions: new JsonDocumentOptions { MaxDepth = 256 })!;

    private static void Set(JsonNode node, string[] path, JsonNode value)
    {
        for (int i = 0; i < path.Length - 1; i++)
        {
            JsonNode? next = node is JsonArray array ? array[int.Parse(path[i], System.Globalization.CultureInfo.InvariantCulture)] : node[path[i]];
            if (next is null)
                node[path[i]] = next = new JsonObject();
            node = next;
        }

        if (node is JsonArray list)
            list[int.Parse(path[path.Length - 1], System.Globalization.CultureInfo.InvariantCulture)] = value;
        else
            node[path[path.Length - 1]] = value;
    }
}
