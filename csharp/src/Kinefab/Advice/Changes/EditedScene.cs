using System;
using System.Collections.Generic;
using System.Text;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Validation;

namespace Kinefab.Advice.Changes;

/// <summary>Makes changes in a scene's text and reads it anew: the way that a user's own edit goes.</summary>
internal static class EditedScene
{
    /// <summary>The scene with the edits made; null when it is not valid with them.</summary>
    public static ValidScene? Apply(ValidScene scene, IEnumerable<SceneEdit> edits)
    {
        JsonTree root = JsonTree.Parse(scene.Document.Text.Span);
        foreach (SceneEdit edit in edits)
            root.Set(edit.Pointer, JsonTree.Parse(edit.Value));

        // Two buffers may name one file.
        var buffers = new Dictionary<string, ReadOnlyMemory<byte>?>(StringComparer.Ordinal);
        foreach (SceneBuffer buffer in scene.Document.Buffers)
            buffers[buffer.Uri] = buffer.Data;
        SceneReading reading = SceneFile.Parse(Encoding.UTF8.GetBytes(root.ToString()), uri => buffers.TryGetValue(uri, out ReadOnlyMemory<byte>? data) ? data : null);
        return reading.Document is null ? null : SceneValidator.Validate(reading.Document).Scene;
    }

    /// <summary>A component as the file has it.</summary>
    public static JsonTree Component(ValidScene scene, int gameObject, int component) =>
        JsonTree.Parse(scene.Document.Text.Span)["gameObjects"]![gameObject]["components"]![component];
}
