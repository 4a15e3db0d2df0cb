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
        foreach (Island island in e.Islands)
        {
            Threshold threshold = Threshold.Drift(island);
            AdviceMeasure truth = e.Worst(e.Exact, island, r => r.Shake).Measure;
            (Dynamics.WorldJoint? joint, AdviceMeasure before) = e.Worst(e.Unity, island, r => r.Shake);
            double score = threshold.Score(before);
            if (joint is null || score < 1 || threshold.Score(truth) > score / 2)
                continue;
            var treatment = Treatment.Of(e, island, run => e.Worst(run, island, r => r.Shake).Measure, threshold, e.Remedies.Ladders);
            yield return FindingText.Make(
                DiagnosticCodes.AdviceJointShakes, Severity.Warning, EditText.Pointer(joint), joint.Id, before, score, treatment,
                ("joint", JointSettings.Place(e.Scene, joint)),
                ("measure", before.ToString()));
        }
    }
}
