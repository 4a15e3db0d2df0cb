using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json;
using System.Text.RegularExpressions;
using Kinefab.Tests.Conformance;

namespace Kinefab.Tests.Cli;

/// <summary>Holds JSON to the schemas of this repository: the keywords that they use, and no others.</summary>
internal sealed class JsonSchema
{
    private static readonly string Folder = Path.Combine(ConformanceCases.Folder, "..", "..", "schemas");

    private static readonly string[] Remarks = ["$schema", "$id", "$defs", "title", "description"];

    private readonly JsonElement _root;
    private readonly List<string> _faults = [];

    private JsonSchema(string name) => _root = JsonDocument.Parse(File.ReadAllText(Path.Combine(Folder, name))).RootElement;

    /// <summary>Where and why a text does not follow a schema; empty when it does.</summary>
    /// <param name="name">File in schemas/.</param>
    /// <param name="json">The text.</param>
    public static IReadOnlyList<string> Faults(string name, string json)
    {
        var schema = new JsonSchema(name);
        schema.Check(JsonDocument.Parse(json).RootElement, schema._root, "");
        return schema._faults;
    }

    private void Check(JsonElement value, JsonElement schema, string at)
    {
        foreach (JsonProperty rule in schema.EnumerateObject())
        {
            if (!Remarks.Contains(rule.Name) && !Holds(rule, value, schema, at))
                _faults.Add($"{at}: {rule.Name} {rule.Value}");
        }
    }

    private bool Holds(JsonProperty rule, JsonElement value, JsonElement schema, string at)
    {
        JsonElement wanted = rule.Value;
        switch (rule.Name)
        {
            case "$ref":
                Refer(value, wanted.GetString()!, at);
                return true;
            case "type":
                return IsOf(value, wanted.GetString()!);
            case "enum":
                return wanted.EnumerateArray().Any(w => w.ToString() == value.ToString());
            case "const":
                return wanted.ToString() == value.ToString();
            case "pattern":
                return Regex.IsMatch(value.GetString()!, wanted.GetString()!);
            case "minimum":
                return value.GetDouble() >= wanted.GetDouble();
            case "exclusiveMinimum":
                return value.GetDouble() > wanted.GetDouble();
            case "minItems":
                return value.GetArrayLength() >= wanted.GetInt32();
            case "minProperties":
                return value.EnumerateObject().Count() >= wanted.GetInt32();
            case "required":
                return wanted.EnumerateArray().All(w => value.TryGetProperty(w.GetString()!, out _));
            case "items":
                int i = 0;
                foreach (JsonElement item in value.EnumerateArray())
                    Check(item, wanted, $"{at}/{i++}");
                return true;
            case "properties":
                foreach (JsonProperty field in value.EnumerateObject())
                {
                    if (wanted.TryGetProperty(field.Name, out JsonElement inner))
                        Check(field.Value, inner, $"{at}/{field.Name}");
                }

                return true;
            case "additionalProperties" when wanted.ValueKind == JsonValueKind.False:
                return value.EnumerateObject().All(f => schema.GetProperty("properties").TryGetProperty(f.Name, out _));
            default:
                throw new NotSupportedException($"The keyword {rule.Name} is not known here.");
        }
    }

    private void Refer(JsonElement value, string reference, string at)
    {
        string[] parts = reference.Split('#');
        JsonSchema target = parts[0].Length == 0 ? this : new JsonSchema(parts[0]["kinefab.".Length..]);
        JsonElement schema = parts[1].Split('/', StringSplitOptions.RemoveEmptyEntries).Aggregate(target._root, (node, step) => node.GetProperty(step));
        target.Check(value, schema, at);
        if (target != this)
            _faults.AddRange(target._faults);
    }

    private static bool IsOf(JsonElement value, string type) => type switch
    {
        "object" => value.ValueKind == JsonValueKind.Object,
        "array" => value.ValueKind == JsonValueKind.Array,
        "string" => value.ValueKind == JsonValueKind.String,
        "boolean" => value.ValueKind is JsonValueKind.True or JsonValueKind.False,
        "number" => value.ValueKind == JsonValueKind.Number,
        "integer" => value.ValueKind == JsonValueKind.Number && value.TryGetInt64(out _),
        _ => throw new NotSupportedException($"The type {type} is not known here."),
    };
}
