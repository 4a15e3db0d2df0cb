using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Runtime.Loader;
using Kinefab.Tests.Conformance;
using Microsoft.CodeAnalysis;
using Microsoft.CodeAnalysis.CSharp;
using NUnit.Framework;

namespace Kinefab.Tests.UnityPackage;

/// <summary>The editors that the package is for, by their defines, and its sources compiled as each of them would: C# 9.</summary>
internal static class UnityEditors
{
    private static readonly string[] Steps =
    [
        "2021.3", "2022.1", "2022.2", "2022.3", "2023.1", "2023.2", "2023.3", "6000.0", "6000.1", "6000.2", "6000.3", "6000.4", "6000.5", "6000.6", "6000.7", "7000.0",
    ];

    private static readonly string Repository = Path.GetFullPath(Path.Combine(ConformanceCases.Folder, "..", ".."));

    /// <summary>By name, "6000.0".</summary>
    public static IEnumerable<string> All => Steps;

    /// <summary>What a user's editor defines.</summary>
    public static IEnumerable<string> Defines(string editor) =>
        Steps.Take(System.Array.IndexOf(Steps, editor) + 1).Select(step => $"UNITY_{step.Replace('.', '_')}_OR_NEWER").Append($"UNITY_{editor.Replace('.', '_')}");

    /// <summary>Package and stand-ins, with further defines, as one assembly; <paramref name="isEditor"/>: with the editor's part.</summary>
    public static CSharpCompilation Compile(string editor, bool isEditor, params string[] more)
    {
        IEnumerable<string> defines = Defines(editor).Concat(more).Concat(isEditor ? ["UNITY_EDITOR"] : []);
        var options = new CSharpParseOptions(LanguageVersion.CSharp9, preprocessorSymbols: defines);
        IEnumerable<string> folders = [StandIns, Package("Runtime"), .. isEditor ? new[] { Package("Editor") } : []];
        IEnumerable<SyntaxTree> trees = folders.SelectMany(Sources).Select(path => CSharpSyntaxTree.ParseText(File.ReadAllText(path), options, path));
        return CSharpCompilation.Create("Kinefab.Unity", trees, References(), new CSharpCompilationOptions(OutputKind.DynamicallyLinkedLibrary));
    }

    /// <summary>What <c>Play.Run(argument)</c> of a script returns in a built player of an editor.</summary>
    public static string Run(string editor, string script, string argument, params string[] more)
    {
        CSharpCompilation all = Compile(editor, isEditor: false, more);
        all = all.AddSyntaxTrees(CSharpSyntaxTree.ParseText(script, (CSharpParseOptions)all.SyntaxTrees[0].Options));
        using var image = new MemoryStream();
        Assert.That(all.Emit(image).Diagnostics.Where(d => d.Severity == DiagnosticSeverity.Error).Select(d => d.ToString()), Is.Empty);
        image.Position = 0;
        var context = new AssemblyLoadContext($"player of {editor}", isCollectible: true);
        string told = (string)context.LoadFromStream(image).GetType("Play")!.GetMethod("Run")!.Invoke(null, [argument])!;
        context.Unload();
        return told;
    }

    /// <summary>The package's own tests too, which Unity's runner runs.</summary>
    public static CSharpCompilation CompileTests(string editor)
    {
        CSharpCompilation all = Compile(editor, isEditor: true, "ENABLE_LEGACY_INPUT_MANAGER", "UNITY_INCLUDE_TESTS");
        var options = (CSharpParseOptions)all.SyntaxTrees[0].Options;
        return all.AddSyntaxTrees(Sources(Package("Tests")).Select(path => CSharpSyntaxTree.ParseText(File.ReadAllText(path), options, path)))
            .AddReferences(MetadataReference.CreateFromFile(typeof(TestAttribute).Assembly.Location));
    }

    /// <summary>A project's assemblies, each as its asmdef has it: the package, the script that prefabs bring along, and what the user writes against them.</summary>
    public static IEnumerable<Diagnostic> CompileProject(string editor, bool hasPackage, bool hasScript, string own)
    {
        var options = new CSharpParseOptions(LanguageVersion.CSharp9, preprocessorSymbols: [.. Defines(editor), "UNITY_EDITOR", "ENABLE_LEGACY_INPUT_MANAGER"]);
        string script = Path.Combine(Repository, "python", "src", "kinefab", "targets", "prefab", "scripts", "KinefabCoupling.cs");
        CSharpCompilation engine = Assembly("UnityEngine", Sources(StandIns).Select(File.ReadAllText));
        List<CSharpCompilation> all = [engine];
        if (hasPackage)
            all.Add(Assembly("Kinefab.Unity", Sources(Package("Runtime")).Select(File.ReadAllText), engine));
        if (hasScript)
            all.Add(Assembly("Kinefab.Couplings", [File.ReadAllText(script)], engine));
        all.Add(Assembly("Assembly-CSharp", [own], [.. all]));
        return all.SelectMany(one => one.GetDiagnostics()).Where(d => d.Severity == DiagnosticSeverity.Error);

        CSharpCompilation Assembly(string name, IEnumerable<string> sources, params CSharpCompilation[] references) =>
            CSharpCompilation.Create(name, sources.Select(text => CSharpSyntaxTree.ParseText(text, options)), [.. References(), .. references.Select(one => one.ToMetadataReference())], new CSharpCompilationOptions(OutputKind.DynamicallyLinkedLibrary));
    }

    /// <summary>Whether a file is the package's, not a stand-in.</summary>
    public static bool IsPackage(string path) => !path.StartsWith(StandIns, System.StringComparison.Ordinal);

    private static string StandIns => Path.Combine(Repository, "tests", "csharp", "UnityStandIns");

    private static string Package(string part) => Path.Combine(Repository, "csharp", "unity", "com.kinefab", part);

    private static IEnumerable<string> Sources(string folder) => Directory.GetFiles(folder, "*.cs", SearchOption.AllDirectories)
        .Where(path => !path.Contains($"{Path.DirectorySeparatorChar}obj{Path.DirectorySeparatorChar}", System.StringComparison.Ordinal) && !path.Contains($"{Path.DirectorySeparatorChar}bin{Path.DirectorySeparatorChar}", System.StringComparison.Ordinal));

    private static IEnumerable<MetadataReference> References() => ((string)System.AppContext.GetData("TRUSTED_PLATFORM_ASSEMBLIES")!).Split(Path.PathSeparator)
        .Where(path => Path.GetFileName(path) is string name && (name.StartsWith("System.", System.StringComparison.Ordinal) || name is "mscorlib.dll" or "netstandard.dll" or "Kinefab.dll"))
        .Select(path => MetadataReference.CreateFromFile(path));
}
