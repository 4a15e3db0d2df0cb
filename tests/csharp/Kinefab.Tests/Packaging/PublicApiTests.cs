using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Runtime.CompilerServices;
using Kinefab.Document;
using Kinefab.Tests.Conformance;
using NUnit.Framework;

namespace Kinefab.Tests.Packaging;

/// <summary>Everything public is listed in PublicApi.txt, so that a change of it is seen in review.</summary>
public class PublicApiTests
{
    private const BindingFlags Own = BindingFlags.Public | BindingFlags.Instance | BindingFlags.Static | BindingFlags.DeclaredOnly;

    [Test]
    public void PublicApi_AgainstTheList_IsTheSame()
    {
        string actual = string.Join("\n", typeof(SceneDocument).Assembly.GetExportedTypes().OrderBy(type => type.FullName, StringComparer.Ordinal).SelectMany(Lines)) + "\n";
        string list = Path.Combine(ConformanceCases.Folder, "..", "csharp", "Kinefab.Tests", "Packaging", "PublicApi.txt");
        string written = Path.Combine(AppContext.BaseDirectory, "PublicApi.actual.txt");
        File.WriteAllText(written, actual);
        Assert.That(actual, Is.EqualTo(File.Exists(list) ? File.ReadAllText(list) : ""), $"If the change is meant, copy {written} over {list}.");
    }

    private static IEnumerable<string> Lines(Type type)
    {
        string kind = type.IsEnum ? "enum" : type.IsValueType ? "struct" : type.IsInterface ? "interface" : type.IsAbstract && type.IsSealed ? "static class" : type.IsAbstract ? "abstract class" : "class";
        kind = type.GetMethod("<Clone>$") is null ? kind : kind.Replace("class", "record", StringComparison.Ordinal);
        yield return $"{kind} {type.FullName}";
        IEnumerable<string> members = type.GetMembers(Own).Where(IsListed).Select(member => "    " + Describe(member));
        foreach (string member in members.Order(StringComparer.Ordinal))
            yield return member;
    }

    /// <summary>Accessors are listed with their property; an enum's value__ is no one's business.</summary>
    private static bool IsListed(MemberInfo member) => member switch
    {
        // What every record has is not listed for each.
        MethodInfo method when method.IsDefined(typeof(CompilerGeneratedAttribute)) => false,
        MethodInfo { IsSpecialName: true } method => method.Name.StartsWith("op_", StringComparison.Ordinal),
        FieldInfo field => !field.IsSpecialName,
        _ => true,
    };

    private static string Describe(MemberInfo member) => member switch
    {
        FieldInfo { IsLiteral: true } constant => $"{constant.Name} = {constant.GetRawConstantValue()}",
        PropertyInfo property => $"{property} {{ {string.Join(" ", property.GetAccessors().Select(Accessor))} }}",
        _ => member.ToString()!,
    };

    private static string Accessor(MethodInfo accessor)
    {
        if (accessor.ReturnType != typeof(void))
            return "get;";
        return accessor.ReturnParameter.GetRequiredCustomModifiers().Length > 0 ? "init;" : "set;";
    }
}
