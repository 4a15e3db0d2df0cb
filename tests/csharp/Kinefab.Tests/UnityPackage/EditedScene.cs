using System;
using System.IO;
using System.Linq;
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

    public string Scene => Path.Combine(folder, "lever.kinefab").Replace('\\', '/');

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
        JsonNode[] all = [.. Objects.Select(o => o!.DeepClone())];
        foreach (JsonNode entry in all)
        {
            if (entry["parent"] is JsonNode parent)
                entry["parent"] = to[(int)parent];
            foreach (JsonNode? component in entry["components"]?.AsArray() ?? [])
            {
                if (component!["connectedBody"] is JsonNode other)
                    component["connectedBody"] = to[(int)other];
            }
        }

        Json["gameObjects"] = new JsonArray([.. order.Select(i => all[i])]);
        foreach (string aside in new[] { "analysis", "constraints" })
            Json.Remove(aside);
        Save();
    }

    public void Dispose() => Directory.Delete(folder, recursive: true);

    private int Depth(int index) => Objects[index]!["parent"] is JsonNode parent ? 1 + Depth((int)parent) : 0;
}
