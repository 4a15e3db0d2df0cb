using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;

namespace Kinefab.Advice.Findings;

/// <summary>
/// A known cause of trouble that stands in the file. It is a warning only where the joints of its island do drift and
/// removing it is measured to help; else the file is cleared of it with an info.
/// </summary>
internal static class Suspects
{
    /// <summary>Of the islands that hold suspects the ones whose joints drift most.</summary>
    public static IReadOnlyList<RunIsland> Islands(Examination e, Func<RunIsland, bool> holds) =>
        e.WorstFirst(e.Islands.Where(holds), i => Threshold.Drift(i).Score(e.WorstDrift(e.Unity, i).Measure), least: 0);

    /// <summary>The finding about a suspect.</summary>
    /// <param name="e">The scene.</param>
    /// <param name="island">Where the suspect stands.</param>
    /// <param name="code">What it is.</param>
    /// <param name="pointer">Its place.</param>
    /// <param name="id">Its object.</param>
    /// <param name="cures">Changes that take the suspect away.</param>
    /// <param name="values">For the message, "measure" left out.</param>
    public static AdviceFinding Judge(
        Examination e, RunIsland island, string code, string pointer, string id, IEnumerable<Change?> cures, params (string Name, string Value)[] values)
    {
        Threshold threshold = Threshold.Drift(island);
        AdviceMeasure before = e.WorstDrift(e.Unity, island).Measure;
        double score = threshold.Score(before);
        var treatment = Treatment.Of(e, island, run => e.WorstDrift(run, island).Measure, threshold, cures.OfType<Change>().Select(c => new[] { c }));
        bool isGuilty = score >= 1 && treatment.Best is not null;
        return FindingText.Make(
            code, isGuilty ? Severity.Warning : Severity.Info, pointer, id, before, score, treatment.Tried, isGuilty ? treatment.Best : null,
            values.Append(("measure", before.ToString())).ToArray());
    }
}
