using System.Linq;
using Microsoft.CodeAnalysis;
using Microsoft.CodeAnalysis.CSharp;
using Microsoft.CodeAnalysis.CSharp.Syntax;

namespace Kinefab.Nouns;

/// <summary>
/// Completes the nouns of the scene format: a sealed partial record below <c>DocumentObject</c> is read and written by its
/// public init properties, in their order, a base's first; an enum with <c>[Words]</c> gets its table of words.
/// </summary>
[Generator(LanguageNames.CSharp)]
public sealed class NounGenerator : IIncrementalGenerator
{
    /// <inheritdoc/>
    public void Initialize(IncrementalGeneratorInitializationContext context)
    {
        IncrementalValuesProvider<(string Name, string Text)> nouns = context.SyntaxProvider.CreateSyntaxProvider(
            static (node, _) => node is RecordDeclarationSyntax { BaseList: not null } record
                && record.Modifiers.Any(SyntaxKind.PartialKeyword) && record.Modifiers.Any(SyntaxKind.SealedKeyword),
            static (at, cancellation) => at.SemanticModel.GetDeclaredSymbol((RecordDeclarationSyntax)at.Node, cancellation) is INamedTypeSymbol noun && IsNoun(noun)
                ? (noun.Name, NounText.Of(noun))
                : default);
        context.RegisterSourceOutput(nouns.Where(static noun => noun.Name is not null), static (output, noun) => output.AddSource(noun.Name + ".g.cs", noun.Text));

        IncrementalValuesProvider<(string Name, string Text)> words = context.SyntaxProvider.ForAttributeWithMetadataName(
            "Kinefab.Document.WordsAttribute",
            static (_, _) => true,
            static (at, _) => (at.TargetSymbol.Name, WordsText.Of((INamedTypeSymbol)at.TargetSymbol, at.Attributes[0])));
        context.RegisterSourceOutput(words, static (output, of) => output.AddSource(of.Name + "Words.g.cs", of.Text));
    }

    private static bool IsNoun(INamedTypeSymbol type)
    {
        for (INamedTypeSymbol? at = type.BaseType; at is not null; at = at.BaseType)
        {
            if (at.Name == "DocumentObject")
                return true;
        }

        return false;
    }
}
