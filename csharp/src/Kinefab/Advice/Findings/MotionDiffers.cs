using System.Collections.Generic;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Advice.Findings;

/// <summary>Bodies that Unity's solver moves otherwise than the mechanism truly moves: the worst of each island.</summary>
internal static class MotionDiffers
{
    public static IEnumerable<AdviceFinding> Find(Examination e)
    {
        foreach (RunIsland island in e.WorstFirst(i => Threshold.Place(i).Score(e.WorstPlace(e.Unity, i).Measure)))
        {
            Threshold threshold = Threshold.Place(island);
            (Dynamics.WorldBody body, AdviceMeasure before) = e.WorstPlace(e.Unity, island);
            double score = threshold.Score(before);
            var treatment = Treatment.Of(e, island, run => e.WorstPlace(run, island).Measure, threshold, e.Remedies.Ladders);
            yield return FindingText.Make(
                DiagnosticCodes.AdviceMotionDiffers, Severity.Warning, "/gameObjects/" + Invariant.Text(body.GameObject), body.Id, before, score, treatment,
                ("body", body.Id),
                ("measure", before.ToString()),
                ("seconds", AdviceMeasure.Text(e.Foreseen[island.Index] * e.Plan.Step)));
        }
    }
}
