using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Runtime.CompilerServices;
using Microsoft.CodeAnalysis;
using Microsoft.CodeAnalysis.CSharp;
using Microsoft.CodeAnalysis.CSharp.Syntax;

namespace Kinefab.Tests.Architecture;

/// <summary>Files of C# and which of them name types of which others, as the compiler reads them.</summary>
internal sealed class House
{
    private House(IReadOnlyList<string> files, IReadOnlyList<(string File, string Used)> imports)
    {
        Files = files;
        Imports = imports;
    }

    /// <summary>Paths from the library's folder, with slashes.</summary>
    public IReadOnlyList<string> Files { get; }

    /// <summary>A file and one that it names a type of; of a partial type the file that bears its name alone.</summary>
    public IReadOnlyList<(string File, string Used)> Imports { get; }

    /// <summary>The sources of Kinefab as they lie in the checkout.</summary>
    public static House OfLibrary([CallerFilePath] string here = "")
    {
        string folder = Path.GetFullPath(Path.Combine(Path.GetDirectoryName(here)!, "..", "..", "..", "..", "csharp", "src", "Kinefab"));
        return Of(Directory.GetFiles(folder, "*.cs", SearchOption.AllDirectories)
            .Select(file => Path.GetRelativePath(folder, file).Replace('\\', '/'))
            .Where(file => !file.StartsWith("bin/", StringComparison.Ordinal) && !file.StartsWith("obj/", StringComparison.Ordinal))
            .ToDictionary(file => file, file => File.ReadAllText(Path.Combine(folder, file))));
    }

    /// <summary>Of texts by their paths.</summary>
    public static House Of(IReadOnlyDictionary<string, string> texts)
    {
        var options = new CSharpParseOptions(LanguageVersion.Latest, preprocessorSymbols: ["NET"]);
        List<SyntaxTree> trees = texts.OrderBy(text => text.Key, StringComparer.Ordinal)
            .Select(text => CSharpSyntaxTree.ParseText(text.Value, options, text.Key)).ToList();
        IEnumerable<MetadataReference> framework = ((string)AppContext.GetData("TRUSTED_PLATFORM_ASSEMBLIES")!).Split(Path.PathSeparator)
            .Where(path => Path.GetFileName(path).StartsWith("System.", StringComparison.Ordinal))
            .Select(path => MetadataReference.CreateFromFile(path));
        var compilation = CSharpCompilation.Create("House", trees, framework, new CSharpCompilationOptions(OutputKind.DynamicallyLinkedLibrary));
        var imports = new SortedSet<(string, string)>();
        foreach (SyntaxTree tree in trees)
        {
            SemanticModel model = compilation.GetSemanticModel(tree);
            foreach (SimpleNameSyntax name in tree.GetRoot().DescendantNodes().OfType<SimpleNameSyntax>().Where(name => name is not IdentifierNameSyntax { IsVar: true }))
            {
                if (Named(model.GetSymbolInfo(name)) is INamedTypeSymbol type && HomeOf(type) is string home && home != tree.FilePath)
                    imports.Add((tree.FilePath, home));
            }
        }

        return new House(trees.ConvertAll(tree => tree.FilePath), imports.ToList());
    }

    /// <summary>The folder of a file; empty at the top.</summary>
    public static string RoomOf(string file) => file.Contains('/', StringComparison.Ordinal) ? file[..file.LastIndexOf('/')] : "";

    /// <summary>The topmost folder of a file.</summary>
    public static string HallOf(string file) => file.Split('/')[0];

    /// <summary>Sets of files each of which needs all the others (Tarjan's strongly connected components of two files and more).</summary>
    public IReadOnlyList<string[]> Circles()
    {
        ILookup<string, string> uses = Imports.ToLookup(import => import.File, import => import.Used);
        var index = new Dictionary<string, int>();
        var low = new Dictionary<string, int>();
        var open = new Stack<string>();
        var circles = new List<string[]>();
        foreach (string file in Files)
        {
            if (!index.ContainsKey(file))
                Visit(file);
        }

        return circles;

        void Visit(string file)
        {
            index[file] = low[file] = index.Count;
            open.Push(file);
            foreach (string used in uses[file])
            {
                if (!index.ContainsKey(used))
                    Visit(used);
                if (open.Contains(used))
                    low[file] = Math.Min(low[file], low[used]);
            }

            if (low[file] != index[file])
                return;
            var circle = new List<string>();
            do
            {
                circle.Add(open.Pop());
            }
            while (circle[^1] != file);
            if (circle.Count > 1)
                circles.Add(circle.Order(StringComparer.Ordinal).ToArray());
        }
    }

    // A type, or the class that holds an extension method: what else a file uses of another it got from somebody who names it.
    private static INamedTypeSymbol? Named(SymbolInfo info) => (info.Symbol ?? info.CandidateSymbols.FirstOrDefault()) switch
    {
        INamedTypeSymbol type => type.OriginalDefinition,
        IMethodSymbol { MethodKind: MethodKind.Constructor } constructor => constructor.ContainingType.OriginalDefinition,
        IMethodSymbol { MethodKind: MethodKind.ReducedExtension } extension => extension.ContainingType,
        _ => null,
    };

    private static string? HomeOf(INamedTypeSymbol type)
    {
        while (type.ContainingType is INamedTypeSymbol outer)
            type = outer;
        string[] files = type.DeclaringSyntaxReferences.Select(declared => declared.SyntaxTree.FilePath).ToArray();
        return files.FirstOrDefault(file => Path.GetFileName(file) == $"{type.Name}.cs") ?? files.FirstOrDefault();
    }
}
