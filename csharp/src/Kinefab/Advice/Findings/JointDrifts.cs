using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;

namespace Kinefab.Advice.Findings;

/// <summary>Joints whose anchors or axes come apart in Unity's solver: the worst of each island.</summary>
internal static class JointDrifts
{
    public static IEnumerable<AdviceFinding> Find(Examination e)
    {
        foreach (RunIsland island in e.WorstFirst(i => Threshold.Drift(i).Score(e.WorstDrift(e.Unity, i).Measure)))
        {
            Threshold threshold = Threshold.Drift(island);
            (Dynamics.WorldJoint joint, AdviceMeasure before) = e.WorstDrift(e.Unity, island);
            double score = threshold.Score(before);
            int others = island.Joints.Count(j => threshold.Score(e.Unity.Joints[j].Drift) >= 1) - 1;
            var treatment = Treatment.Of(e, island, run => e.WorstDrift(run, island).Measure, threshold, e.Remedies.Ladders);
            yield return FindingText.Make(
                DiagnosticCodes.AdviceJointDrifts, Severity.Warning, EditText.Pointer(joint), joint.Id, before, score, treatment,
                ("joint", JointSettings.Place(e.Scene, joint)),
                ("measure", before.ToString()),
                ("seconds", AdviceMeasure.Text(e.Plan.Seconds)),
                ("others", others == 0 ? "" : $"; so {(others == 1 ? "does" : "do")} {others} more of its mechanism"));
        }
    }
}
