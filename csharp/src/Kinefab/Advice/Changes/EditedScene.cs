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
        if (SceneFile.Parse(Encoding.UTF8.GetBytes(root.ToString())).Document is not SceneDocument edited)
            return null;

        // No edit changes them.
        for (int i = 0; i < edited.Buffers.Count; i++)
            edited.Buffers[i].Attach(scene.Document.Buffers[i].Data);
        return SceneValidator.Validate(edited).Scene;
    }

    /// <summary>A component as the file has it.</summary>
    public static JsonTree Component(ValidScene scene, int gameObject, int component) =>
        JsonTree.Parse(scene.Document.Text.Span)["gameObjects"]![gameObject]["components"]![component];
}
