using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Kinefab.Advice.Findings;
using Kinefab.Advice.Trials;
using Kinefab.Collisions;
using Kinefab.Diagnostics;
using Kinefab.Dynamics;
using Kinefab.Validation;

namespace Kinefab.Advice;

/// <summary>
/// Runs a scene as Unity would and as it truly moves, says what comes apart, shakes or moves otherwise, and tries changes:
/// every number given was measured, before and after. The same scene gives the same advice.
/// </summary>
public static class StabilityAdvice
{
    /// <summary>The advice for a scene.</summary>
    /// <param name="scene">A scene that was read from a text: changes are made in it as in the file.</param>
    /// <param name="options">Null: the default ones.</param>
    /// <param name="cancellation">Ends the runs early.</param>
    /// <returns>What was measured, and the changes that mend it, best first.</returns>
    /// <exception cref="ArgumentException">The scene was not read from a text, or the seconds are no positive finite number.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    /// <example><code>
    /// AdviceReport advice = StabilityAdvice.Of(ValidScene.Load("lever.kinefab"));
    /// foreach (AdviceFinding finding in advice.Findings)
    ///     Console.WriteLine(finding);
    /// </code></example>
    public static AdviceReport Of(ValidScene scene, AdviceOptions? options = null, CancellationToken cancellation = default)
    {
        if (scene is null)
            throw new ArgumentNullException(nameof(scene));
        if (scene.Document.Text.IsEmpty)
            throw new ArgumentException("Advice needs a scene that was read from a text.", nameof(scene));
        if (options?.Seconds is double seconds && !(seconds > 0 && seconds <= double.MaxValue))
            throw new ArgumentException("The seconds must be a positive finite number.", nameof(options));
        var examination = new Examination(scene, options ?? new AdviceOptions(), cancellation);
        AdviceFinding[] findings = examination.Unity.IsSound
            ? Findings(examination)
                .OrderBy(f => f.Diagnostic.Severity == Severity.Warning ? 0 : 1)
                .ThenByDescending(f => f.Score)
                .ThenBy(f => f.Diagnostic.Pointer, StringComparer.Ordinal)
                .ThenBy(f => f.Diagnostic.Code, StringComparer.Ordinal)
                .ToArray()
            : Array.Empty<AdviceFinding>();
        return new AdviceReport(examination.Plan.Step, examination.Plan.Samples, examination.Workbench.Count, findings, Remarks(examination, cancellation));
    }

    private static IEnumerable<AdviceFinding> Findings(Examination e) =>
        // Weak drives are only found by runs: before the cures of others have used the budget up.
        WeakDrives.Find(e)
            .Concat(JointDrifts.Find(e))
            .Concat(MotionDiffers.Find(e))
            .Concat(JointShakes.Find(e))
            .Concat(RingingDrives.Find(e))
            .Concat(UnlikeMasses.Find(e))
            .Concat(ThinInertias.Find(e))
            .Concat(RepeatedRows.Find(e))
            .Concat(NarrowLimits.Find(e));

    private static Report Remarks(Examination e, CancellationToken cancellation)
    {
        var found = new List<Diagnostic>();
        if (!e.Unity.IsSound)
            found.Add(Remark(DiagnosticCodes.AdviceCannotFollow, ("solver", "unity"), ("trouble", e.Unity.Trouble)));
        if (e.ExactTrouble.Length > 0)
            found.Add(Remark(DiagnosticCodes.AdviceCannotFollow, ("solver", "exact"), ("trouble", e.ExactTrouble)));
        if (e.Omitted > 0)
            found.Add(Remark(DiagnosticCodes.FindingsOmitted, ("count", Json.Invariant.Text(e.Omitted))));
        if (e.IsShortened)
            found.Add(Remark(DiagnosticCodes.AdviceRunShortened, ("seconds", AdviceMeasure.Text(e.Plan.Seconds))));
        if (e.Mobility is null)
            found.Add(Remark(DiagnosticCodes.AdviceLoopsUncounted, ("count", Json.Invariant.Text(e.World.Joints.Count))));
        if (e.Remedies.RowsUntried > 0)
            found.Add(Remark(DiagnosticCodes.AdviceRowsUntried, ("count", Json.Invariant.Text(e.Remedies.RowsUntried))));
        if (e.Workbench.IsSpent)
            found.Add(Remark(DiagnosticCodes.AdviceTrialsSpent, ("count", Json.Invariant.Text(e.Workbench.Count))));
        return new Report(e.World.Findings.Diagnostics.Concat(ExactSolverCheck.Of(e.Scene)).Concat(StartOverlaps.Of(e.Scene, cancellation).Diagnostics).Concat(found).ToArray());
    }

    private static Diagnostic Remark(string code, params (string Name, string Value)[] values)
    {
        DiagnosticTable.Entry entry = DiagnosticTable.Entries[code];
        return new Diagnostic(code, entry.Severity, DiagnosticTable.Fill(entry.Message, values), DiagnosticTable.Fill(entry.Remedy, values), "", null, null);
    }
}
