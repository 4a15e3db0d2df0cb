using System;
using System.IO;
using System.Linq;
using Kinefab.Diagnostics;
using NUnit.Framework.Constraints;

namespace Kinefab.NUnit;

/// <summary>
/// A file that cannot be tested, as a failure that says what is wrong with it: an exception would show people the library's insides,
/// and the file's name not at all.
/// </summary>
internal static class FaultyFile
{
    /// <summary>What the constraint finds, or which findings keep the file from being tested.</summary>
    public static ConstraintResult OrResult(IConstraint constraint, object? actual, Func<ConstraintResult> judge)
    {
        try
        {
            return judge();
        }
        catch (SceneFormatException fault)
        {
            return Errors(constraint, actual, fault.Report);
        }
        catch (InvalidDataException fault)
        {
            return new MechanismResult(constraint, actual, isSuccess: false, fault.Message);
        }
    }

    /// <summary>Holds without errors; else each is shown with its place and remedy.</summary>
    public static ConstraintResult Errors(IConstraint constraint, object? actual, Report report)
    {
        Diagnostic[] errors = report.Diagnostics.Where(d => d.Severity == Severity.Error).ToArray();
        string found = errors.Length == 1 ? "1 error" : $"{errors.Length} errors";
        string file = actual switch
        {
            string path => $" in {path}",
            FileInfo info => $" in {info.FullName}",
            _ => "",
        };
        return new MechanismResult(constraint, actual, errors.Length == 0, found + file, [.. errors.Select(Line)]);
    }

    private static string Line(Diagnostic finding) =>
        $"{finding.Code} {finding.Pointer}{(finding.Line is int line ? $" line {line}" : "")}: {finding.Message} {finding.Remedy}";
}
