using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Linq;
using Microsoft.CodeAnalysis.CSharp;
using Microsoft.CodeAnalysis.CSharp.Syntax;

namespace Kinefab.Tests.UnityPackage;

/// <summary>
/// What an editor has, by Unity's own public sources (repository UnityCsReference, a tag for each editor). They are read where they lie;
/// their licence allows no more, and nothing of them stands here.
/// </summary>
internal sealed class UnityReference
{
    private readonly Dictionary<string, List<Member>> members = [];
    private readonly Dictionary<string, List<string>> bases = [];

    private UnityReference()
    {
    }

    /// <param name="repository">Git directory of the sources.</param>
    /// <param name="tag">Of the editor.</param>
    /// <param name="types">Names of the types that are looked for.</param>
    public static UnityReference Read(string repository, string tag, IEnumerable<string> types)
    {
        var reference = new UnityReference();
        HashSet<string> wanted = [.. types], seen = [];
        for (HashSet<string> next = [.. wanted]; next.Count > 0;)
        {
            string pattern = $"(class|struct|enum|interface) ({string.Join('|', next)})\\b";
            foreach (string file in Git(repository, "grep", "-l", "-E", pattern, tag, "--", "Runtime", "Editor", "Modules", "artifacts").Split('\n', StringSplitOptions.RemoveEmptyEntries))
            {
                if (file.EndsWith(".cs", StringComparison.Ordinal) && !file.Contains("/Tests/", StringComparison.Ordinal) && seen.Add(file))
                    reference.Add(Git(repository, "show", file));
            }

            // What they inherit from has to be looked at too.
            HashSet<string> above = [.. next.SelectMany(t => reference.bases.GetValueOrDefault(t, []))];
            above.ExceptWith(wanted);
            wanted.UnionWith(above);
            next = above;
        }

        return reference;
    }

    public bool Has(string type) => members.ContainsKey(type);

    /// <summary>Members of a name, those of base types too.</summary>
    public IEnumerable<Member> Of(string type, string name)
    {
        var open = new Queue<string>([type]);
        HashSet<string> seen = [];
        while (open.TryDequeue(out string? at))
        {
            if (!seen.Add(at))
                continue;
            foreach (Member member in members.GetValueOrDefault(at, []).Where(m => m.Name == name))
                yield return member;
            foreach (string above in bases.GetValueOrDefault(at, []))
                open.Enqueue(above);
        }
    }

    private static string Git(string repository, params string[] arguments)
    {
        using var done = Process.Start(new ProcessStartInfo("git", ["-C", repository, .. arguments]) { RedirectStandardOutput = true, RedirectStandardError = true })!;
        string text = done.StandardOutput.ReadToEnd();
        done.WaitForExit();
        return text;
    }

    private void Add(string source)
    {
        var options = new CSharpParseOptions(LanguageVersion.Latest, preprocessorSymbols: ["UNITY_EDITOR", "ENABLE_PHYSICS"]);
        foreach (BaseTypeDeclarationSyntax type in CSharpSyntaxTree.ParseText(source, options).GetRoot().DescendantNodes().OfType<BaseTypeDeclarationSyntax>())
        {
            string name = type.Identifier.Text;
            List<Member> found = members.TryGetValue(name, out List<Member>? known) ? known : members[name] = [];
            bases.TryAdd(name, []);
            bases[name].AddRange(type.BaseList?.Types.Select(t => Simple(t.Type.ToString())) ?? []);
            if (type is EnumDeclarationSyntax words)
            {
                found.AddRange(words.Members.Select(m => new Member(m.Identifier.Text, null, name, Obsolete(m.AttributeLists))));
            }
            else if (type is TypeDeclarationSyntax holder)
            {
                foreach (MemberDeclarationSyntax member in holder.Members)
                    found.AddRange(Members(member, name));
            }
        }
    }

    private static IEnumerable<Member> Members(MemberDeclarationSyntax member, string owner)
    {
        bool? obsolete = Obsolete(member.AttributeLists);
        switch (member)
        {
            case MethodDeclarationSyntax method:
                yield return new Member(method.Identifier.Text, Parameters(method.ParameterList), Simple(method.ReturnType.ToString()), obsolete);
                break;
            case ConstructorDeclarationSyntax made:
                yield return new Member(".ctor", Parameters(made.ParameterList), owner, obsolete);
                break;
            case PropertyDeclarationSyntax property:
                yield return new Member(property.Identifier.Text, null, Simple(property.Type.ToString()), obsolete);
                break;
            case FieldDeclarationSyntax field:
                foreach (VariableDeclaratorSyntax variable in field.Declaration.Variables)
                    yield return new Member(variable.Identifier.Text, null, Simple(field.Declaration.Type.ToString()), obsolete);
                break;
            case EventFieldDeclarationSyntax field:
                foreach (VariableDeclaratorSyntax variable in field.Declaration.Variables)
                    yield return new Member(variable.Identifier.Text, null, Simple(field.Declaration.Type.ToString()), obsolete);
                break;
        }
    }

    private static Parameter[] Parameters(ParameterListSyntax list) =>
        [.. list.Parameters.Select(p => new Parameter(Simple(p.Type?.ToString() ?? ""), p.Default is not null || p.AttributeLists.ToString().Contains("DefaultValue", StringComparison.Ordinal) || p.Modifiers.ToString().Contains("params", StringComparison.Ordinal)))];

    // Null: it is not; true: an error.
    private static bool? Obsolete(IEnumerable<AttributeListSyntax> lists)
    {
        AttributeSyntax? found = lists.SelectMany(l => l.Attributes).FirstOrDefault(a => a.Name.ToString() is "Obsolete" or "System.Obsolete" or "ObsoleteAttribute");
        return found is null ? null : found.ArgumentList?.Arguments.Any(a => a.ToString() == "true") == true;
    }

    /// <summary>A type's name without its namespace, arguments kept.</summary>
    public static string Simple(string type)
    {
        int open = type.IndexOf('<', StringComparison.Ordinal);
        string head = open < 0 ? type : type[..open];
        return head[(head.LastIndexOf('.') + 1)..] + (open < 0 ? "" : type[open..]);
    }

    /// <summary>One member.  Parameters: null where it is no method.  IsObsolete: null: no; false: with a warning; true: an error.</summary>
    public sealed record Member(string Name, Parameter[]? Parameters, string Type, bool? IsObsolete);

    /// <summary>IsOptional: a call may leave it out.</summary>
    public sealed record Parameter(string Type, bool IsOptional);
}
