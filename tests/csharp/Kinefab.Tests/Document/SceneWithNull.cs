using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using Kinefab.Document;
using NUnit.Framework;

namespace Kinefab.Tests.Document;

/// <summary>Documents made in code with a null where none belongs: each list, string and object of each public type once, by its types' own annotations.</summary>
internal static class SceneWithNull
{
    private static readonly SceneDocument Whole = new()
    {
        Generator = new Generator(), Source = new SceneSource(), Physics = new Physics(), Analysis = new Analysis { Islands = [new AnalysisIsland()], Bodies = [new BodyFreedom()] },
        Buffers = [new SceneBuffer { Uri = "a.bin" }], Meshes = [new Mesh { Submeshes = [new Submesh()] }], Images = [new Image()], Materials = [new Material()], PhysicsMaterials = [new PhysicsMaterial()],
        Couplings = [new Coupling { Terms = [new CouplingTerm()] }], IgnoredCollisions = [new IgnoredCollision()],
        Animations = [new AnimationClip { Tracks = [new AnimationTrack()] }], Report = [new ReportEntry()],
        Constraints = [new Constraint { Features = [new Feature()], Reading = new Dictionary<string, string> { ["a/b"] = "c" } }],
        GameObjects =
        [
            new GameObject
            {
                Id = "a",
                Components = [new Rigidbody(), new ConfigurableJoint { Stated = new StatedAxes() }, new HingeJoint(), new ArticulationBody(), new MeshRenderer()],
            },
        ],
    };

    /// <summary>Pointer, what belongs there, document.</summary>
    public static IEnumerable<TestCaseData> All => Of(Whole, "").Select(made => new TestCaseData(made.Pointer, made.Expected, made.Made).SetArgDisplayNames(made.Pointer))
        .Append(new TestCaseData("/constraints/0/reading/a~1b", "a string", Whole with { Constraints = [Whole.Constraints[0] with { Reading = new Dictionary<string, string> { ["a/b"] = null! } }] })
            .SetArgDisplayNames("/constraints/0/reading/a~1b"));

    private static IEnumerable<(string Pointer, string Expected, DocumentObject Made)> Of(DocumentObject noun, string at)
    {
        foreach (PropertyInfo property in noun.GetType().GetProperties().Where(property => property.SetMethod is not null))
        {
            string pointer = $"{at}/{char.ToLowerInvariant(property.Name[0])}{property.Name[1..]}";
            object? value = property.GetValue(noun);
            bool copies = property.Name is nameof(SceneDocument.GameObjects) or nameof(GameObject.Components);
            bool isList = property.PropertyType.IsGenericType && property.PropertyType.Name.StartsWith("IReadOnly", StringComparison.Ordinal);
            string expected = property.PropertyType == typeof(string) ? "a string" : property.PropertyType.Name.StartsWith("IReadOnlyList", StringComparison.Ordinal) ? "an array" : "an object";
            bool isNoun = typeof(DocumentObject).IsAssignableFrom(property.PropertyType);
            if ((isNoun || isList || property.PropertyType == typeof(string)) && new NullabilityInfoContext().Create(property).WriteState == NullabilityState.NotNull && !copies)
                yield return (pointer, expected, With(noun, property, null));
            if (value is DocumentObject part)
            {
                foreach ((string inner, string belongs, DocumentObject made) in Of(part, pointer))
                    yield return (inner, belongs, With(noun, property, made));
            }

            if (!isList || property.PropertyType.GetGenericArguments() is not [Type item] || item.IsValueType)
                continue;
            object?[] items = [.. ((IEnumerable<object>)value!)];
            for (int i = 0; i <= items.Length; i++)
            {
                // One more than there are is the null.
                if (i == items.Length)
                    yield return ($"{pointer}/{i}", item == typeof(string) ? "a string" : "an object", With(noun, property, Items(item, [.. items, null])));
                else if (items[i] is DocumentObject one)
                {
                    foreach ((string inner, string belongs, DocumentObject made) in Of(one, $"{pointer}/{i}"))
                        yield return (inner, belongs, With(noun, property, Items(item, [.. items[..i], made, .. items[(i + 1)..]])));
                }
            }
        }
    }

    private static Array Items(Type item, object?[] items)
    {
        var typed = Array.CreateInstance(item, items.Length);
        Array.Copy(items, typed, items.Length);
        return typed;
    }

    private static DocumentObject With(DocumentObject noun, PropertyInfo property, object? value)
    {
        var copy = (DocumentObject)noun.GetType().GetMethod("<Clone>$")!.Invoke(noun, null)!;
        property.SetValue(copy, value);
        return copy;
    }
}
