using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Validation;
using Island = Kinefab.Advice.Runs.Island;

namespace Kinefab.Advice.Findings;

/// <summary>Rotations limited to less than 5 degrees: whether Unity's solver keeps within them.</summary>
internal static class NarrowLimits
{
    private const double Narrow = 5;

    public static IEnumerable<AdviceFinding> Find(Examination e)
    {
        foreach (Island island in e.Islands)
        {
            foreach (int j in island.Joints)
            {
                JointRecord record = e.Unity.Joints[j];
                JointFreedom narrow = record.Freedoms.FirstOrDefault(f => f.IsAngle && f.IsLimited && f.Upper - f.Lower < Narrow);
                if (narrow.IsLimited && narrow.IsAngle && narrow.Upper > narrow.Lower)
                    yield return Judge(e, island, j, narrow);
            }
        }
    }

    private static AdviceFinding Judge(Examination e, Island island, int j, JointFreedom narrow)
    {
        WorldJoint joint = e.World.Joints[j];
        Threshold threshold = Threshold.Drift(island);
        AdviceMeasure before = Measure(e.Unity);
        double score = threshold.Score(before);
        IEnumerable<Change[]> ladders = score < 1
            ? new[] { e.Remedies.SmallerSteps.Take(1).ToArray() }
            : e.Remedies.Ladders.Concat(new[] { new[] { Locked(e, joint, narrow) }.OfType<Change>().ToArray() });
        var treatment = Treatment.Of(e, island, Measure, threshold, ladders);
        return FindingText.Make(
            DiagnosticCodes.AdviceLimitNarrow, score < 1 ? Severity.Info : Severity.Warning, EditText.Pointer(joint), joint.Id, before, score,
            treatment.Tried, score < 1 ? null : treatment.Best,
            ("joint", JointSettings.Place(e.Scene, joint)),
            ("range", AdviceMeasure.Text(narrow.Upper - narrow.Lower)),
            ("measure", before.ToString()));

        AdviceMeasure Measure(SceneRun run) => new(0, run.Joints[j].Overshoot.Angle);
    }

    // So little room may as well be none: only a ConfigurableJoint can lock the axis it limits.
    private static Change? Locked(Examination e, WorldJoint joint, JointFreedom narrow)
    {
        if (JointSettings.Of(e.Scene, joint) is not ConfigurableJoint)
            return null;
        MotionField axis = MotionField.Of(narrow.Coordinate);
        string pointer = $"{EditText.Pointer(joint)}/{axis.Name}";
        return new Change(
            "lock " + pointer,
            new[]
            {
                new ChangePart(
                    joint.GameObject, axis.Label + " Limited -> Locked", JointSettings.Place(e.Scene, joint), new SceneEdit(pointer, "\"Locked\"")),
            });
    }
}
