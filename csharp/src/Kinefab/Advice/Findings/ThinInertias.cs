using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;
using Kinefab.Dynamics;
using Kinefab.Numerics;

namespace Kinefab.Advice.Findings;

/// <summary>Bodies that their weight would turn by more than a radian within one step: the worst of each island.</summary>
internal static class ThinInertias
{
    public static IEnumerable<AdviceFinding> Find(Examination e)
    {
        Vector3d[] turns = BodySettings.TurnsInAStep(e.World, e.Plan.Step);
        IEnumerable<Change?> cures = e.Remedies.SmallerSteps.Prepend(e.Remedies.InertiasRaised);
        foreach (RunIsland island in Suspects.Islands(e, i => i.Bodies.Any(b => Largest(turns[b]) > 1)))
        {
            int worst = island.Bodies.OrderByDescending(b => Largest(turns[b])).First();
            WorldBody body = e.World.Bodies[worst];
            yield return Suspects.Judge(
                e, island, DiagnosticCodes.AdviceInertiaThin, BodySettings.Pointer(e.Scene, body), body.Id, cures,
                ("body", body.Id),
                ("turn", AdviceMeasure.Text(Largest(turns[worst]))));
        }
    }

    private static double Largest(Vector3d v) => Math.Max(v.X, Math.Max(v.Y, v.Z));
}
