using System;
using System.Collections.Generic;
using System.Linq;
using Microsoft.CodeAnalysis;
using Microsoft.CodeAnalysis.CSharp;
using Microsoft.CodeAnalysis.CSharp.Syntax;
using NUnit.Framework;

namespace Kinefab.Tests.UnityPackage;

/// <summary>
/// Every member of UnityEngine and UnityEditor that the package uses stands in Unity's own sources, with these parameters, and is not
/// obsolete there. Runs where KINEFAB_UNITY_REFERENCE names the git directory of the repository UnityCsReference.
/// </summary>
public sealed class UnityReferenceTests
{
    [TestCase("2021.3.0f1", "2021.3")]
    [TestCase("2022.3.0f1", "2022.3")]
    [TestCase("6000.0.0f1", "6000.0")]
    [TestCase("6000.3.0f1", "6000.3")]
    [TestCase("6000.5.0f1", "6000.5")]
    [TestCase("6000.7.0a1", "6000.7")]
    public void Members_ThatThePackageUses_AreInUnity(string tag, string editor)
    {
        string? repository = Environment.GetEnvironmentVariable("KINEFAB_UNITY_REFERENCE");
        if (string.IsNullOrEmpty(repository))
            Assert.Ignore("KINEFAB_UNITY_REFERENCE does not name Unity's reference sources");
        HashSet<ISymbol> used = Used(editor);
        UnityReference unity = UnityReference.Read(repository!, tag, used.Select(s => Owner(s).Name).Distinct());
        List<string> faults = [.. used.Select(symbol => Fault(symbol, unity)).OfType<string>().Order(StringComparer.Ordinal)];
        TestContext.Out.WriteLine($"{tag}: {used.Count} members of {used.Select(s => Owner(s).Name).Distinct().Count()} types");
        Assert.That(used, Has.Count.GreaterThan(150));
        Assert.That(faults, Is.Empty);
    }

    // So that the test above could fail at all.
    [Test]
    public void Members_ThatUnityGaveUp_AreSeenToBeObsolete()
    {
        string? repository = Environment.GetEnvironmentVariable("KINEFAB_UNITY_REFERENCE");
        if (string.IsNullOrEmpty(repository))
            Assert.Ignore("KINEFAB_UNITY_REFERENCE does not name Unity's reference sources");
        UnityReference unity = UnityReference.Read(repository!, "6000.5.0f1", ["Rigidbody"]);
        Assert.That(unity.Of("Rigidbody", "drag").Select(m => m.IsObsolete).Distinct(), Is.EqualTo(new bool?[] { false }).Or.EqualTo(new bool?[] { true }));
        Assert.That(unity.Of("Rigidbody", "GetInstanceID").Select(m => m.IsObsolete), Does.Contain(true));
        Assert.That(unity.Of("Rigidbody", "nothing"), Is.Empty);
    }

    private static INamedTypeSymbol Owner(ISymbol symbol) => symbol as INamedTypeSymbol ?? symbol.ContainingType;

    // Members by their definitions; types only where they are named.
    private static HashSet<ISymbol> Used(string editor)
    {
        var found = new HashSet<ISymbol>(SymbolEqualityComparer.Default);
        CSharpCompilation all = UnityEditors.Compile(editor, isEditor: true, "ENABLE_LEGACY_INPUT_MANAGER");
        foreach (SyntaxTree tree in all.SyntaxTrees.Where(t => UnityEditors.IsPackage(t.FilePath)))
        {
            SemanticModel model = all.GetSemanticModel(tree);
            foreach (SyntaxNode node in tree.GetRoot().DescendantNodes().Where(n => n is SimpleNameSyntax or BaseObjectCreationExpressionSyntax or AttributeSyntax))
            {
                if (model.GetSymbolInfo(node).Symbol is not ISymbol symbol || symbol is INamespaceSymbol or ILocalSymbol or IParameterSymbol or IRangeVariableSymbol or ITypeParameterSymbol)
                    continue;
                symbol = (symbol as IMethodSymbol)?.ReducedFrom ?? symbol.OriginalDefinition;
                string space = (symbol as INamedTypeSymbol ?? symbol.ContainingType)?.ContainingNamespace.ToString() ?? "";
                bool isImplicit = symbol is IMethodSymbol { IsImplicitlyDeclared: true };
                if (!isImplicit && (space.StartsWith("UnityEngine", StringComparison.Ordinal) || space.StartsWith("UnityEditor", StringComparison.Ordinal)))
                    found.Add(symbol);
            }
        }

        return found;
    }

    private static string? Fault(ISymbol symbol, UnityReference unity)
    {
        string owner = Owner(symbol).Name;
        if (!unity.Has(owner))
            return $"{owner}: no such type";
        if (symbol is INamedTypeSymbol)
            return null;
        string name = symbol is IMethodSymbol { MethodKind: MethodKind.Constructor } ? ".ctor" : symbol.Name;
        UnityReference.Member[] found = [.. unity.Of(owner, name)];
        string told = $"{owner}.{name}";
        if (found.Length == 0)
            return $"{told}: no such member";
        if (symbol is IMethodSymbol method)
        {
            string[] wanted = [.. method.Parameters.Select(p => UnityReference.Simple(p.Type.ToDisplayString(SymbolDisplayFormat.MinimallyQualifiedFormat)))];
            found = [.. found.Where(m => m.Parameters is not null && Takes(m.Parameters, wanted))];
            if (found.Length == 0)
                return $"{told}({string.Join(", ", wanted)}): no such overload";
        }

        return found.All(m => m.IsObsolete is not null) ? $"{told}: obsolete{(found[0].IsObsolete == true ? ", an error" : "")}" : null;
    }

    private static bool Takes(UnityReference.Parameter[] parameters, string[] wanted) =>
        wanted.Length <= parameters.Length
        && wanted.Zip(parameters).All(pair => Same(pair.First, pair.Second.Type))
        && parameters.Skip(wanted.Length).All(p => p.IsOptional);

    private static bool Same(string own, string unitys) =>
        own == unitys || own.Replace("Single", "float", StringComparison.Ordinal) == unitys || (own.EndsWith("[]", StringComparison.Ordinal) && unitys.EndsWith("[]", StringComparison.Ordinal) && Same(own[..^2], UnityReference.Simple(unitys[..^2])))
        || own.TrimEnd('?') == unitys.TrimEnd('?') || (own == "T" && unitys.Length <= 2 && unitys[0] == 'T') || (own == "Type" && unitys == "System.Type");
}
