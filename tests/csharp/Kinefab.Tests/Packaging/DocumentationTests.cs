using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Runtime.CompilerServices;
using System.Text.RegularExpressions;
using System.Xml.Linq;
using Kinefab.Document;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Packaging;

/// <summary>What IntelliSense shows: each public method says what it takes and gives, each number its unit. That there is a summary is the compiler's to see (CS1591).</summary>
public class DocumentationTests
{
    private const BindingFlags Own = BindingFlags.Public | BindingFlags.Instance | BindingFlags.Static | BindingFlags.DeclaredOnly;

    // What a number may be counted in, or that it has no unit.
    private static readonly Regex Unit = new(
        @"degree|metre|radian|\bkg\b|\bN\b|\bN m|m/s|\bJ\b|second|\brad\b|\bHz\b|\bs\b|in units of|\bunit\b|ratio|scale|share|factor|per cent|0 to 1|component|cosine|length|vector part|scalar part|\([01], [01], [01]\)|without unit|as <see",
        RegexOptions.IgnoreCase);

    private static IEnumerable<Assembly> Libraries => [typeof(SceneDocument).Assembly, typeof(Kinefab.NUnit.Keeps).Assembly];

    [TestCaseSource(nameof(Libraries))]
    public void PublicMethods_EachOne_SayWhatTheyTakeAndGive(Assembly library)
    {
        Dictionary<string, XElement> documented = Members(library);
        var silent = new List<string>();
        foreach (MethodBase method in library.GetExportedTypes().SelectMany(Methods))
        {
            if (!documented.TryGetValue(Id(method), out XElement? text) || text.Element("inheritdoc") is not null)
                continue;
            HashSet<string?> told = text.Elements("param").Select(param => param.Attribute("name")?.Value).ToHashSet();
            silent.AddRange(method.GetParameters().Where(taken => !told.Contains(taken.Name)).Select(taken => $"{Id(method)}: {taken.Name}"));
            if (method is MethodInfo { ReturnType: Type given } && given != typeof(void) && text.Element("returns") is null)
                silent.Add(Id(method) + ": what it gives");
        }

        Assert.That(silent, Is.Empty);
    }

    [TestCaseSource(nameof(Libraries))]
    public void PublicNumbers_EachOne_HaveTheirUnit(Assembly library)
    {
        Dictionary<string, XElement> documented = Members(library);
        IEnumerable<string> numbers = library.GetExportedTypes()
            .SelectMany(type => type.GetProperties(Own))
            .Where(property => (Nullable.GetUnderlyingType(property.PropertyType) ?? property.PropertyType) is Type type && (type == typeof(double) || type == typeof(Vector3d)))
            .Select(Id);
        Assert.That(numbers.Where(number => documented.TryGetValue(number, out XElement? text) && text.Element("inheritdoc") is null && !Unit.IsMatch(text.ToString())), Is.Empty);
    }

    /// <summary>Operators, what records bring and what overrides object's are plain by their kind.</summary>
    private static IEnumerable<MethodBase> Methods(Type type) => type.GetConstructors(Own).Cast<MethodBase>().Concat(type.GetMethods(Own).Where(method =>
        !method.IsSpecialName && method.GetBaseDefinition() == method && !method.IsDefined(typeof(CompilerGeneratedAttribute))));

    private static Dictionary<string, XElement> Members(Assembly library) =>
        XDocument.Load(Path.ChangeExtension(library.Location, ".xml")).Descendants("member").ToDictionary(member => member.Attribute("name")!.Value);

    // The compiler's names: https://learn.microsoft.com/dotnet/csharp/language-reference/xmldoc/#id-strings
    private static string Id(MemberInfo member)
    {
        IEnumerable<ParameterInfo> parameters = member switch
        {
            MethodBase method => method.GetParameters(),
            PropertyInfo property => property.GetIndexParameters(),
            _ => [],
        };
        string name = member is ConstructorInfo ? "#ctor" : member.Name;
        string arity = member is MethodInfo { IsGenericMethod: true } generic ? "``" + generic.GetGenericArguments().Length : "";
        string list = string.Join(",", parameters.Select(parameter => Id(parameter.ParameterType)));
        return $"{(member is PropertyInfo ? 'P' : 'M')}:{Id(member.DeclaringType!)}.{name}{arity}{(list.Length > 0 ? $"({list})" : "")}";
    }

    private static string Id(Type type)
    {
        if (type.IsByRef)
            return Id(type.GetElementType()!) + "@";
        if (type.IsArray)
            return Id(type.GetElementType()!) + "[]";
        if (type.IsGenericParameter)
            return (type.DeclaringMethod is null ? "`" : "``") + type.GenericParameterPosition;
        if (type.IsConstructedGenericType)
            return type.GetGenericTypeDefinition().FullName!.Split('`')[0].Replace('+', '.') + "{" + string.Join(",", type.GetGenericArguments().Select(Id)) + "}";
        return type.FullName!.Replace('+', '.');
    }
}
