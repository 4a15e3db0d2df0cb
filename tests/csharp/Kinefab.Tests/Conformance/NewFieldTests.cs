using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text;
using System.Text.Json;
using System.Text.Json.Nodes;
using Kinefab.Diagnostics;
using Kinefab.Document;
using NUnit.Framework;

namespace Kinefab.Tests.Conformance;

/// <summary>Every field that version 1.0 lacks (<c>since</c> in the schema) stands in a case that is valid, and a wrong value there is an error there.</summary>
public class NewFieldTests
{
    private static readonly JsonElement Schema = JsonDocument.Parse(
        File.ReadAllText(Path.Combine(ConformanceCases.Folder, "..", "..", "schemas", "scene.schema.json"))).RootElement;

    private static readonly JsonElement Definitions = Schema.GetProperty("$defs");

    private static IEnumerable<string> Valid => ConformanceCases.All
        .Where(entry => entry.Kind == "scene" && entry.Expect == "valid" && File.ReadAllBytes(entry.FullPath)[0] == '{').Select(entry => entry.Path);

    [Test]
    public void Fields_SinceVersion1_1_AllStandInAValidCase()
    {
        IEnumerable<string> stated = Valid.SelectMany(path => NewFields(Parse(path))).Select(field => field.Name);
        IEnumerable<string> needed = Definitions.EnumerateObject().Append(Root())
            .SelectMany(noun => Properties(noun.Value).Where(field => IsNew(noun.Value) || IsNew(field.Value)).Select(field => $"{noun.Name}.{field.Name}"));
        Assert.That(needed.Except(stated), Is.Empty);
    }

    [TestCaseSource(nameof(Valid))]
    public void Field_OfAnotherKind_IsAnErrorAtItsPlace(string path)
    {
        foreach (string pointer in NewFields(Parse(path)).Select(field => field.Pointer).Distinct())
        {
            JsonNode whole = Parse(path);
            string[] steps = pointer[1..].Split('/');
            JsonNode holder = steps[..^1].Aggregate(whole, (at, step) => at is JsonArray list ? list[int.Parse(step)]! : at[step]!);
            JsonNode wrong = holder[steps[^1]]!.GetValueKind() == JsonValueKind.Number ? JsonValue.Create("seven") : JsonValue.Create(7);
            holder[steps[^1]] = wrong;
            Report report = SceneFile.Load(new MemoryStream(Encoding.UTF8.GetBytes(whole.ToJsonString())), Path.GetDirectoryName(Path.Combine(ConformanceCases.Folder, path))!).Report;
            Assert.That(report.Diagnostics.Where(found => found.Severity == Severity.Error).Select(found => found.Pointer), Has.Some.EqualTo(pointer));
        }
    }

    private static JsonProperty Root() => JsonDocument.Parse($$"""{"scene": {{Schema.GetRawText()}}}""").RootElement.EnumerateObject().Single();

    private static JsonNode Parse(string path) => JsonNode.Parse(File.ReadAllText(Path.Combine(ConformanceCases.Folder, path)).TrimStart('\uFEFF'))!;

    private static bool IsNew(JsonElement definition) => definition.TryGetProperty("since", out _);

    private static IEnumerable<JsonProperty> Properties(JsonElement noun) =>
        noun.TryGetProperty("properties", out JsonElement properties) ? properties.EnumerateObject().Where(p => p.Name is not ("type" or "extras")) : [];

    private static IEnumerable<(string Name, string Pointer)> NewFields(JsonNode whole) => Within(whole, "scene", Schema, "");

    private static IEnumerable<(string Name, string Pointer)> Within(JsonNode? value, string name, JsonElement noun, string pointer)
    {
        if (noun.TryGetProperty("$ref", out JsonElement reference))
        {
            name = reference.GetString()!.Split('/')[^1];
            noun = Definitions.GetProperty(name);
        }

        if (noun.TryGetProperty("oneOf", out _) && value is JsonObject component && component["type"] is JsonValue type)
        {
            name = type.GetValue<string>();
            noun = Definitions.GetProperty(name);
        }

        if (value is JsonArray list && noun.TryGetProperty("items", out JsonElement items))
            return list.SelectMany((item, i) => Within(item, name, items, $"{pointer}/{i}"));
        if (value is not JsonObject entry)
            return [];
        return Properties(noun).Where(field => entry.ContainsKey(field.Name)).SelectMany(field => Within(entry[field.Name], name, field.Value, $"{pointer}/{field.Name}")
            .Concat(IsNew(noun) || IsNew(field.Value) ? [($"{name}.{field.Name}", $"{pointer}/{field.Name}")] : []));
    }
}
