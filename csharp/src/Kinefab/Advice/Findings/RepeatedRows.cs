using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;
using Kinefab.Json;
using Kinefab.Kinematics;

namespace Kinefab.Advice.Findings;

/// <summary>Loops that hold some of their freedoms twice, by island.</summary>
internal static class RepeatedRows
{
    public static IEnumerable<AdviceFinding> Find(Examination e)
    {
        if (e.Mobility is not { Redundant: > 0 } counted)
            yield break;
        Change?[] cures = { e.Remedies.ClosuresMinimal, e.Remedies.PreprocessingOff };
        foreach (RunIsland island in Suspects.Islands(e, i => counted.Joints.Any(j => i.Holds(j.GameObject, j.Component))))
        {
            RedundantRows[] joints = counted.Joints.Where(j => island.Holds(j.GameObject, j.Component)).OrderByDescending(j => j.Redundant).ToArray();
            yield return Suspects.Judge(
                e, island, DiagnosticCodes.AdviceLoopOverConstrained, EditText.Component(joints[0].GameObject, joints[0].Component),
                e.Scene.Document.GameObjects[joints[0].GameObject].Id, cures,
                ("joint", JointSettings.Place(e.Scene, joints[0].GameObject, joints[0].Component)),
                ("count", Invariant.Text(joints[0].Redundant)),
                ("rows", Invariant.Text(joints[0].Rows)),
                ("others", joints.Length == 1 ? "" : $", and some of {joints.Length - 1} more of its mechanism"));
        }
    }
}
