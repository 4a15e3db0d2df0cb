using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Text.Json.Nodes;
using Kinefab.Advice;
using Kinefab.Validation;

namespace Kinefab.Tests.Advice;

/// <summary>A tried change made by hand: the file edited on disk and loaded.</summary>
internal static class AdviceEdits
{
    public static ValidScene Apply(string file, IEnumerable<SceneEdit> edits)
    {
        JsonNode root = JsonNode.Parse(File.ReadAllText(file))!;
        foreach (SceneEdit edit in edits)
        {
            string[] path = edit.Pointer.Split('/')[1..];
            JsonNode at = root;
            foreach (string step in path[..^1])
            {
                if (at is JsonArray array)
                    at = array[int.Parse(step, CultureInfo.InvariantCulture)]!;
                else
                    at = at[step] ?? (at[step] = new JsonObject());
            }

            JsonNode value = JsonNode.Parse(edit.Value)!;
            if (at is JsonArray list)
                list[int.Parse(path[^1], CultureInfo.InvariantCulture)] = value;
            else
                at[path[^1]] = value;
        }

        // Beside the original, whose buffers it names.
        string folder = Directory.CreateTempSubdirectory("kinefab").FullName;
        try
        {
            foreach (string beside in Directory.GetFiles(Path.GetDirectoryName(file)!, "*.bin"))
                File.Copy(beside, Path.Combine(folder, Path.GetFileName(beside)));
            string edited = Path.Combine(folder, Path.GetFileName(file));
            File.WriteAllText(edited, root.ToJsonString());
            return ValidScene.Load(edited);
        }
        finally
        {
            Directory.Delete(folder, recursive: true);
        }
    }
}
