using System.Collections.Generic;
using System.Linq;
using Microsoft.CodeAnalysis;

namespace Kinefab.Nouns;

/// <summary>A property of a noun as a field of the file.</summary>
internal sealed class Field
{
    private readonly AttributeData? attribute;

    private Field(IPropertySymbol property)
    {
        attribute = property.GetAttributes().FirstOrDefault(given => given.AttributeClass?.Name == "FieldAttribute");
        Property = property.Name;
        Type = property.Type;
        Name = property.Name == "ExtrasJson" ? "extras" : char.ToLowerInvariant(Property[0]) + Property.Substring(1);
        Since = Minor(property);
        IsInFile = Argument("InFile", property.DeclaredAccessibility == Accessibility.Public || attribute is not null);
    }

    internal string Property { get; }

    internal string Name { get; }

    internal ITypeSymbol Type { get; }

    /// <summary>Whether a file without it is faulty; then it is always written.</summary>
    internal bool IsRequired => Argument("Required", false);

    /// <summary>Whether it is written at its default too.</summary>
    internal bool IsAlwaysWritten => IsRequired || Argument("Always", false);

    /// <summary>Whether many objects have the same text there.</summary>
    internal bool IsShared => Argument("Shared", false);

    /// <summary>Fewest items of a list.</summary>
    internal int Least => Argument("Least", 0);

    /// <summary>What is assigned when it is read: the property, or what stands behind it.</summary>
    internal string Into => Argument<string?>("Into", null) ?? Property;

    /// <summary>A method that reads it, or null: the one of its type.</summary>
    internal string? Reader => Argument<string?>("Reader", null);

    /// <summary>Minor version of the format that has it first.</summary>
    internal int Since { get; }

    private bool IsInFile { get; }

    /// <summary>What <c>[Since]</c> says of a noun or a property; 0 without.</summary>
    internal static int Minor(ISymbol of) =>
        of.GetAttributes().FirstOrDefault(given => given.AttributeClass?.Name == "SinceAttribute")?.ConstructorArguments[0].Value as int? ?? 0;

    /// <summary>The fields of a noun in the file's order: those of its bases, its own, extras.</summary>
    internal static IReadOnlyList<Field> Of(INamedTypeSymbol noun)
    {
        var all = new List<Field>();
        for (INamedTypeSymbol at = noun; at.Name != "Object" && at.BaseType is not null; at = at.BaseType)
        {
            IEnumerable<Field> own = at.GetMembers().OfType<IPropertySymbol>()
                .Where(property => property is { IsStatic: false, SetMethod.IsInitOnly: true })
                .Select(property => new Field(property))
                .Where(field => field.IsInFile);
            if (at.Name == "DocumentObject")
                all.AddRange(own);
            else
                all.InsertRange(0, own);
        }

        return all;
    }

    private T Argument<T>(string name, T usual) =>
        attribute?.NamedArguments.FirstOrDefault(given => given.Key == name).Value is { IsNull: false, Value: T value } ? value : usual;
}
