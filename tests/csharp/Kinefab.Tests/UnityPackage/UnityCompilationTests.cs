using System.Collections.Generic;
using System.Linq;
using Microsoft.CodeAnalysis;
using NUnit.Framework;

namespace Kinefab.Tests.UnityPackage;

/// <summary>The package's sources compile for every editor, in the editor and in what it builds, with either way of input.</summary>
public sealed class UnityCompilationTests
{
    private static IEnumerable<TestCaseData> Editors() =>
        UnityEditors.All.SelectMany<string, TestCaseData>(editor => [new(editor, true), new(editor, false)]);

    [TestCaseSource(nameof(Editors))]
    public void Sources_OfEveryEditor_Compile(string editor, bool isEditor)
    {
        // Both ways of input: Unity's templates of 6000 have the package alone, older ones the manager.
        string[] inputs = isEditor ? ["ENABLE_LEGACY_INPUT_MANAGER"] : ["ENABLE_INPUT_SYSTEM", "KINEFAB_INPUT_SYSTEM", "KINEFAB_UGUI"];
        IEnumerable<Diagnostic> errors = UnityEditors.Compile(editor, isEditor, inputs).GetDiagnostics().Where(d => d.Severity == DiagnosticSeverity.Error);
        Assert.That(errors.Select(d => d.ToString()), Is.Empty);
    }

    [TestCase("2021.3")]
    [TestCase("6000.7")]
    public void Tests_OfThePackage_Compile(string editor) =>
        Assert.That(UnityEditors.CompileTests(editor).GetDiagnostics().Where(d => d.Severity == DiagnosticSeverity.Error).Select(d => d.ToString()), Is.Empty);

    // A prefab keeps the script that it came with; a project may have it, the package, or both.
    [TestCase(true, false)]
    [TestCase(false, true)]
    [TestCase(true, true)]
    public void Project_WithThePackageOrAPrefabsScript_Compiles(bool hasPackage, bool hasScript)
    {
        string own = $$"""
            public sealed class Own : UnityEngine.MonoBehaviour
            {
            {{(hasPackage ? "    public KinefabUnity.KinefabCoupling ofTheImport; public KinefabUnity.KinefabMechanism mechanism;" : "")}}
            {{(hasScript ? "    public Kinefab.KinefabCoupling ofThePrefab;" : "")}}
            }
            """;
        Assert.That(UnityEditors.CompileProject("2022.3", hasPackage, hasScript, own).Select(d => d.ToString()), Is.Empty);
    }
}
