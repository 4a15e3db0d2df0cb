using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Validation;
using Island = Kinefab.Advice.Runs.RunIsland;

namespace Kinefab.Advice.Findings;

/// <summary>Rotations limited to less than 5 degrees, and how far Unity's solver goes beyond them: the worst of each island.</summary>
internal static class NarrowLimits
{
    private const double Range = 5;

    public static IEnumerable<AdviceFinding> Find(Examination e)
    {
        IEnumerable<RunIsland> islands = e.Islands.Where(i => i.Joints.Any(j => e.Unity.Joints[j].Freedoms.Any(IsNarrow)));
        foreach (RunIsland island in e.WorstFirst(islands, i => Narrow(e, i)[0].Beyond, least: 0))
            yield return Judge(e, island, Narrow(e, island));
    }

    // Furthest beyond first, degrees.
    private static (int Joint, JointFreedom Freedom, double Beyond)[] Narrow(Examination e, RunIsland island) => island.Joints
        .SelectMany(j => e.Unity.Joints[j].Freedoms.Where(IsNarrow).Select(f => (j, f, Beyond: e.Unity.Joints[j].Overshoot(f.Coordinate))))
        .OrderByDescending(n => n.Beyond)
        .ToArray();

    private static bool IsNarrow(JointFreedom freedom) =>
        freedom.IsAngle && freedom.IsLimited && freedom.Upper > freedom.Lower && freedom.Upper - freedom.Lower < Range;

    private static AdviceFinding Judge(Examination e, RunIsland island, (int Joint, JointFreedom Freedom, double Beyond)[] narrow)
    {
        Threshold threshold = Threshold.Drift(island);
        AdviceMeasure before = Measure(e.Unity);
        double score = threshold.Score(before);
        bool isBad = score >= 1;
        IEnumerable<Change[]> ladders = isBad
            ? e.Remedies.Ladders.Append(new[] { Locked(e, narrow) }.OfType<Change>().ToArray())
            : new[] { e.Remedies.SmallerSteps.Take(1).ToArray() };
        var treatment = Treatment.Of(e, island, Measure, threshold, ladders);
        WorldJoint worst = e.World.Joints[narrow[0].Joint];
        return FindingText.Make(
            DiagnosticCodes.AdviceLimitNarrow, isBad ? Severity.Warning : Severity.Info, EditText.Pointer(worst), worst.Id, before, score,
            treatment.Tried, isBad ? treatment.Best : null,
            ("joint", JointSettings.Place(e.Scene, worst)),
            ("range", AdviceMeasure.Text(narrow[0].Freedom.Upper - narrow[0].Freedom.Lower)),
            ("measure", before.ToString()),
            ("others", narrow.Length == 1 ? "" : $" ({narrow.Length - 1} more of its mechanism {(narrow.Length == 2 ? "is" : "are")} as narrow)"));

        AdviceMeasure Measure(SceneRun run) => new(null, narrow.Max(n => run.Joints[n.Joint].Overshoot(n.Freedom.Coordinate)));
    }

    // So little room may as well be none: only a ConfigurableJoint can lock the axis it limits.
    private static Change? Locked(Examination e, (int Joint, JointFreedom Freedom, double Beyond)[] narrow)
    {
        ChangePart[] parts = narrow.Select(n => (Joint: e.World.Joints[n.Joint], n.Freedom))
            .Where(n => JointSettings.Of(e.Scene, n.Joint) is ConfigurableJoint)
            .Select(n => (n.Joint, Field: MotionField.Of(n.Freedom.Coordinate)))
            .Select(n => new ChangePart(
                n.Joint.GameObject, n.Field.Label + " Limited -> Locked", JointSettings.Place(e.Scene, n.Joint),
                new SceneEdit($"{EditText.Pointer(n.Joint)}/{n.Field.Name}", "\"Locked\"")))
            .ToArray();
        return parts.Length == 0 ? null : new Change("locked " + parts[0].Edits[0].Pointer, parts);
    }
}
