using System.Collections.Generic;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;

namespace Kinefab.Advice.Findings;

/// <summary>Joints that go to and fro with the step in Unity's solver and not in truth: the worst of each island.</summary>
internal static class JointShakes
{
    public static IEnumerable<AdviceFinding> Find(Examination e)
    {
        foreach (RunIsland island in e.WorstFirst(i => Score(e, i)))
        {
            Threshold threshold = Threshold.Drift(island);
            (Dynamics.WorldJoint joint, AdviceMeasure before) = e.Worst(e.Unity, island, r => r.Shake);
            double score = threshold.Score(before);
            var treatment = Treatment.Of(e, island, run => e.Worst(run, island, r => r.Shake).Measure, threshold, e.Remedies.Ladders);
            yield return FindingText.Make(
                DiagnosticCodes.AdviceJointShakes, Severity.Warning, EditText.Pointer(joint), joint.Id, before, score, treatment,
                ("joint", JointSettings.Place(e.Scene, joint)),
                ("measure", before.ToString()));
        }
    }

    // 0 where the true motion shakes half as much or more.
    private static double Score(Examination e, RunIsland island)
    {
        double unity = Threshold.Drift(island).Score(e.Worst(e.Unity, island, r => r.Shake).Measure);
        double exact = !e.Exact.IsSound ? 0 : Threshold.Drift(island).Score(e.Worst(e.Exact, island, r => r.Shake).Measure);
        return exact > unity / 2 ? 0 : unity;
    }
}
