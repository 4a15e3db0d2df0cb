using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Advice;

/// <summary>The stability advice for a scene.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class AdviceReport
{
    internal AdviceReport(double step, int steps, int trials, IReadOnlyList<AdviceFinding> findings, Report remarks)
    {
        Step = step;
        Steps = steps;
        Trials = trials;
        Findings = findings;
        Report = new Report(findings.Select(f => f.Diagnostic).Concat(remarks.Diagnostics).ToArray());
    }

    /// <summary>The scene's own time step, seconds.</summary>
    public double Step { get; }

    /// <summary>Steps simulated in each run.</summary>
    public int Steps { get; }

    /// <summary>Runs beside the scene's own: of changes, and of poses held to see which drives are weak.</summary>
    public int Trials { get; }

    /// <summary>Worst first.</summary>
    public IReadOnlyList<AdviceFinding> Findings { get; }

    /// <summary>The findings as diagnostics, and what kept the advice from being complete.</summary>
    public Report Report { get; }

    /// <summary>120 steps of 0.02 s, 2 findings, 14 changes tried; 1 warning.</summary>
    public override string ToString() => FormattableString.Invariant($"{Invariant.Counted(Steps, "step")} of {Step} s, {Invariant.Counted(Findings.Count, "finding")}, {Invariant.Counted(Trials, "change")} tried; {Report}");
}
