using System;
using System.IO;
using System.Linq;
using System.Text.Json;
using System.Text.Json.Nodes;
using Kinefab.Tests.Conformance;

namespace Kinefab.Tests.UnityPackage;

/// <summary>A fixture in a folder of its own, changed as a second export might change it.</summary>
internal sealed class EditedScene : IDisposable
{
    private static readonly string Fixtures = Path.Combine(ConformanceCases.Folder, "..", "..", "fixtures");
    private readonly string folder = Directory.CreateTempSubdirectory("kinefab-unity-").FullName;

    public EditedScene(string fixture = "lever/lever.kinefab")
    {
        string source = Path.Combine(Fixtures, fixture);
        foreach (string beside in Directory.GetFiles(Path.GetDirectoryName(source)!, "*.bin"))
            File.Copy(beside, Path.Combine(folder, Path.GetFileName(beside)));
        Json = JsonNode.Parse(File.ReadAllText(source))!.AsObject();
        Save();
    }

    public JsonObject Json { get; private set; }

    public JsonArray Objects => Json["gameObjects"]!.AsArray();

    public string Scene => Path.Combine(folder, "scene.kinefab").Replace('\\', '/');

    public string Folder => folder;

    public void Save() => File.WriteAllText(Scene, Json.ToJsonString());

    public void Save(Action<JsonObject> change)
    {
        change(Json);
        Save();
    }

    public int IndexOf(string id) => Objects.Select((o, i) => (Id: (string)o!["id"]!, i)).First(o => o.Id == id).i;

    /// <summary>The objects in another order, parents first; all references follow.</summary>
    public void Reorder(Func<int, int> rank)
    {
        int count = Objects.Count;
        int[] order = [.. Enumerable.Range(0, count).OrderBy(Depth).ThenBy(rank)];
        var to = new int[count];
        for (int i = 0; i < count; i++)
            to[order[i]] = i;
        Renumber(Json, to);
        JsonNode[] all = [.. Objects.Select(o => o!.DeepClone())];
        Json["gameObjects"] = new JsonArray([.. order.Select(i => all[i])]);
        foreach (string aside in new[] { "analysis", "constraints" })
            Json.Remove(aside);
        Save();
    }

    public void Dispose() => Directory.Delete(folder, recursive: true);

    // Indices of objects stand under these names; a and b are numbers in ignoredCollisions only, in couplings objects.
    private static void Renumber(JsonNode? at, int[] to)
    {
        switch (at)
        {
            case JsonArray list:
                foreach (JsonNode? item in list)
                    Renumber(item, to);
                break;
            case JsonObject entry:
                foreach ((string name, JsonNode? value) in entry.ToArray())
                {
                    if (name is "parent" or "connectedBody" or "gameObject" or "a" or "b" && value?.GetValueKind() == JsonValueKind.Number)
                        entry[name] = to[(int)value!];
                    else if (name is not ("analysis" or "constraints"))
                        Renumber(value, to);
                }

                break;
        }
    }

    private int Depth(int index) => Objects[index]!["parent"] is JsonNode parent ? 1 + Depth((int)parent) : 0;
}
