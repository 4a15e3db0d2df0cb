using System.Collections.Generic;
using System.Linq;
using Microsoft.CodeAnalysis;

namespace Kinefab.Nouns;

/// <summary>Code that reads or writes one value, by its type.</summary>
internal static class ValueText
{
    /// <summary>The type of what there is when a value that may be missing is there.</summary>
    internal static ITypeSymbol Present(ITypeSymbol type) =>
        type is INamedTypeSymbol { OriginalDefinition.SpecialType: SpecialType.System_Nullable_T } nullable ? nullable.TypeArguments[0] : type;

    /// <summary>The type of a list's items, or null.</summary>
    internal static ITypeSymbol? Item(ITypeSymbol type) => type is INamedTypeSymbol { Name: "IReadOnlyList" } list ? list.TypeArguments[0] : null;

    internal static bool IsFlags(ITypeSymbol type) => type.TypeKind == TypeKind.Enum && WordsText.IsFlags(type);

    internal static bool IsMap(ITypeSymbol type) => type.Name == "IReadOnlyDictionary";

    /// <summary>An expression that reads a value from the cursor <paramref name="json"/>.</summary>
    internal static string Read(ITypeSymbol type, string json, int least)
    {
        if (Item(type) is ITypeSymbol item)
        {
            string more = least > 0 ? $", least: {least}" : "";
            return $"{json}.List(static (ref JsonCursor at) => {Read(item, "at", 0)}{more})";
        }

        return Present(type) switch
        {
            { SpecialType: SpecialType.System_Double } => $"{json}.Number()",
            { SpecialType: SpecialType.System_Int32 } => $"{json}.Int()",
            { SpecialType: SpecialType.System_Int64 } => $"{json}.Integer()",
            { SpecialType: SpecialType.System_Boolean } => $"{json}.Boolean()",
            { SpecialType: SpecialType.System_String } => $"{json}.Text()",
            { TypeKind: TypeKind.Enum } word => $"{json}.Word({word.Name}Words.Table)",
            { Name: "Vector2d" } => $"{json}.Vector2()",
            { Name: "Vector3d" } => $"{json}.Vector3()",
            { Name: "Quaterniond" } => $"{json}.Quaternion()",
            { Name: "IReadOnlyDictionary" } => $"{json}.Dictionary()",
            { IsRecord: true, IsAbstract: true } noun => $"{noun.Name}Reader.Read(ref {json})",
            { IsRecord: true, IsValueType: false } noun => $"new {noun.Name}(ref {json})",
            { IsValueType: true } value => $"{value.Name}.Read(ref {json})",
            ITypeSymbol other => $"NoWayToRead({other.Name})",
        };
    }

    /// <summary>Statements that write a value to the writer <c>json</c>.</summary>
    internal static string Write(ITypeSymbol type, string value)
    {
        if (Item(type) is ITypeSymbol item)
        {
            // Components stand on lines of their own.
            string lines = item.Name == "Component" ? "lines: true" : "";
            return $"json.BeginArray({lines}); foreach ({item.ToDisplayString()} item in {value}) {{ {Write(item, "item")} }} json.EndArray();";
        }

        if (IsMap(type))
            return $"json.BeginObject(); foreach (KeyValuePair<string, string> entry in {value}) {{ json.Name(entry.Key); json.Value(entry.Value); }} json.EndObject();";
        if (IsFlags(type))
        {
            IEnumerable<string> words = WordsText.Members(type).Select(member => $"if (({value} & {type.Name}.{member.Name}) != 0) json.Value({type.Name}Words.Table.WordOf({type.Name}.{member.Name}));");
            return $"json.BeginArray(); {string.Join(" ", words)} json.EndArray();";
        }

        return type switch
        {
            { TypeKind: TypeKind.Enum } => $"json.Value({type.Name}Words.Table.WordOf({value}));",
            { Name: "Vector2d" } => $"json.Numbers({value}.X, {value}.Y);",
            { Name: "Vector3d" } => $"json.Numbers({value}.X, {value}.Y, {value}.Z);",
            { Name: "Quaterniond" } => $"json.Numbers({value}.X, {value}.Y, {value}.Z, {value}.W);",
            { Name: "Color" } => $"json.Numbers({value}.R, {value}.G, {value}.B, {value}.A);",
            { IsRecord: true, IsValueType: false } => $"{value}.Write(json);",
            _ => $"json.Value({value});",
        };
    }

    /// <summary>A statement that looks for nulls in a field; empty: there can be none.</summary>
    internal static string Search(Field field)
    {
        bool mayMiss = field.Type.NullableAnnotation == NullableAnnotation.Annotated;
        const string into = "static (item, nulls) => item.Search(nulls)";
        if (Item(field.Type) is { IsRecord: true, IsValueType: false })
            return $"nulls.Objects(\"{field.Name}\", {field.Property}, {into});";
        if (Item(field.Type) is ITypeSymbol item)
            return $"nulls.{(item.SpecialType == SpecialType.System_String ? "Texts" : "Array")}(\"{field.Name}\", {field.Property});";
        if (IsMap(field.Type))
            return $"nulls.Map(\"{field.Name}\", {field.Property});";
        if (field.Type.SpecialType == SpecialType.System_String)
            return mayMiss ? "" : $"nulls.Text(\"{field.Name}\", {field.Property});";
        return field.Type is { IsRecord: true, IsValueType: false } ? $"nulls.Object(\"{field.Name}\", {field.Property}, mayMiss: {(mayMiss ? "true" : "false")}, {into});" : "";
    }

    /// <summary>Whether a field has something to say.</summary>
    internal static string Says(Field field, string usual)
    {
        if (Item(field.Type) is not null || IsMap(field.Type))
            return $"{field.Property}.Count > 0";
        bool mayMiss = field.Type.NullableAnnotation == NullableAnnotation.Annotated || !SymbolEqualityComparer.Default.Equals(Present(field.Type), field.Type);
        return mayMiss ? $"{field.Property} is {{ }} {field.Name}Value" : $"{field.Property} != {usual}.{field.Property}";
    }
}
