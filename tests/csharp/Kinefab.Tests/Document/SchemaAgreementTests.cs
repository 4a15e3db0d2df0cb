using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Text.Json;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Numerics;
using Kinefab.Tests.Conformance;
using NUnit.Framework;

namespace Kinefab.Tests.Document;

/// <summary>The types of Kinefab.Document are the schema's definitions: same fields, same defaults, same words.</summary>
public class SchemaAgreementTests
{
    private static readonly JsonElement Schema = JsonDocument.Parse(
        File.ReadAllText(Path.Combine(ConformanceCases.Folder, "..", "..", "schemas", "scene.schema.json"))).RootElement;

    /// <summary>C# names that differ from the schema's.</summary>
    private static readonly Dictionary<string, string> Renamed = new()
    {
        ["AnimationClip"] = "animation", ["AnimationTrack"] = "track", ["SceneBuffer"] = "buffer", ["SceneSource"] = "source",
        ["AnalysisIsland"] = "island",
    };

    private static IEnumerable<Type> Nouns => typeof(SceneDocument).Assembly.GetTypes()
        .Where(type => type.IsSubclassOf(typeof(DocumentObject)) && !type.IsAbstract);

    [TestCaseSource(nameof(Nouns))]
    public void Noun_AgainstItsDefinition_HasTheSameFieldsAndRequiresTheSame(Type noun)
    {
        JsonElement definition = Definition(noun);
        FieldNames fields = Fields(noun);
        string[] names = Enumerable.Range(0, fields.Count).Select(i => fields[i]).ToArray();
        IEnumerable<string> required = names.Where((_, i) => (fields.Required >> i & 1) == 1);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(names, Is.EqualTo(definition.GetProperty("properties").EnumerateObject().Select(property => property.Name)), "in this order they are written");
            Assert.That(required, Is.EquivalentTo(Texts(definition, "required")));
        }
    }

    [TestCaseSource(nameof(Nouns))]
    public void Noun_MadeWithNothingStated_HasTheDefaultsOfTheSchema(Type noun)
    {
        object made = Activator.CreateInstance(noun)!;
        foreach (JsonProperty property in Definition(noun).GetProperty("properties").EnumerateObject())
        {
            if (!property.Value.TryGetProperty("default", out JsonElement expected))
                continue;
            string name = char.ToUpperInvariant(property.Name[0]) + property.Name[1..];
            object actual = noun.GetProperty(name)!.GetValue(made)!;
            Assert.That(Text(actual), Is.EqualTo(Text(expected)), name);
        }
    }

    /// <summary>What version 1.0 lacks: nouns and fields with <c>since</c> in the schema have <c>[Since]</c> of that minor version, and no others.</summary>
    [TestCaseSource(nameof(Nouns))]
    public void Noun_AgainstItsDefinition_IsSinceTheSameVersion(Type noun)
    {
        JsonElement definition = Definition(noun);
        var stated = new Dictionary<string, int> { [""] = Minor(definition) };
        var coded = new Dictionary<string, int> { [""] = Minor(noun) };
        foreach (JsonProperty property in definition.GetProperty("properties").EnumerateObject())
        {
            string name = property.Name == "extras" ? "ExtrasJson" : char.ToUpperInvariant(property.Name[0]) + property.Name[1..];
            if (property.Name == "type")
                continue;
            stated[property.Name] = Minor(property.Value);
            coded[property.Name] = Minor(noun.GetProperty(name, BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic)!);
        }

        Assert.That(coded, Is.EqualTo(stated));

        static int Minor(object of) => of switch
        {
            JsonElement json => json.TryGetProperty("since", out JsonElement since) ? int.Parse(since.GetString()!.Split('.')[1]) : 0,
            MemberInfo member => member.GetCustomAttribute<SinceAttribute>(inherit: false)?.Minor ?? 0,
            _ => throw new ArgumentException("neither schema nor code", nameof(of)),
        };
    }

    [Test]
    public void Nouns_Counted_AreAllDefinitionsWithFields()
    {
        string[] inlined = ["Bounds", "ClosureGap", "SceneDocument"];
        IEnumerable<string> definitions = Schema.GetProperty("$defs").EnumerateObject()
            .Where(definition => definition.Value.TryGetProperty("properties", out _))
            .Select(definition => definition.Name);
        Assert.That(Nouns.Where(noun => !inlined.Contains(noun.Name)).Select(Name), Is.EquivalentTo(definitions));
    }

    [Test]
    public void Words_OfEveryEnumeration_AreThoseOfTheSchema()
    {
        var inSchema = new HashSet<string>();
        CollectEnums(Schema, inSchema);
        IEnumerable<string> inCode = typeof(SceneDocument).Assembly.GetTypes()
            .Where(type => type.Namespace == typeof(SceneDocument).Namespace && type.Name.EndsWith("Words", StringComparison.Ordinal))
            .Select(type => type.GetField("Table", BindingFlags.Static | BindingFlags.NonPublic)!)
            .Select(field => Sorted(((string)field.FieldType.GetProperty("Listing", BindingFlags.Instance | BindingFlags.NonPublic)!.GetValue(field.GetValue(null))!).Split(", ")));
        Assert.That(inCode.Distinct(), Is.EquivalentTo(inSchema));
    }

    private static JsonElement Definition(Type noun) => noun.Name switch
    {
        nameof(SceneDocument) => Schema,
        nameof(Bounds) => Schema.GetProperty("$defs").GetProperty("mesh").GetProperty("properties").GetProperty("bounds"),
        nameof(ClosureGap) => Schema.GetProperty("$defs").GetProperty("analysis").GetProperty("properties").GetProperty("closureGap"),
        _ => Schema.GetProperty("$defs").GetProperty(Name(noun)),
    };

    private static string Name(Type noun)
    {
        if (Renamed.TryGetValue(noun.Name, out string? renamed))
            return renamed;
        return noun.IsSubclassOf(typeof(Component)) ? noun.Name : char.ToLowerInvariant(noun.Name[0]) + noun.Name[1..];
    }

    private static FieldNames Fields(Type noun) =>
        (FieldNames)noun.GetField("Fields", BindingFlags.Static | BindingFlags.NonPublic)!.GetValue(null)!;

    private static IEnumerable<string> Texts(JsonElement definition, string list) =>
        definition.GetProperty(list).EnumerateArray().Select(item => item.GetString()!);

    private static string Text(JsonElement value) => value.ValueKind switch
    {
        JsonValueKind.Array => "[" + string.Join(" ", value.EnumerateArray().Select(item => item.GetDouble())) + "]",
        JsonValueKind.Number => value.GetDouble().ToString(),
        _ => value.ToString().ToLowerInvariant(),
    };

    private static string Text(object value) => value switch
    {
        Vector2d v => $"[{v.X} {v.Y}]",
        Vector3d v => $"[{v.X} {v.Y} {v.Z}]",
        Quaterniond q => $"[{q.X} {q.Y} {q.Z} {q.W}]",
        Color c => $"[{c.R} {c.G} {c.B} {c.A}]",
        RigidbodyConstraints.None => "[]",
        _ => value.ToString()!.ToLowerInvariant(),
    };

    private static string Sorted(IEnumerable<string> words) => string.Join(" ", words.Order(StringComparer.Ordinal));

    private static void CollectEnums(JsonElement element, HashSet<string> found)
    {
        if (element.ValueKind == JsonValueKind.Array)
        {
            foreach (JsonElement item in element.EnumerateArray())
                CollectEnums(item, found);
        }
        else if (element.ValueKind == JsonValueKind.Object)
        {
            foreach (JsonProperty property in element.EnumerateObject())
            {
                if (property.Name == "enum" && property.Value.ValueKind == JsonValueKind.Array)
                    found.Add(Sorted(property.Value.EnumerateArray().Select(item => item.GetString()!)));
                else
                    CollectEnums(property.Value, found);
            }
        }
    }
}
