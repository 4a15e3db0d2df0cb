using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;
using Kinefab.Dynamics;

namespace Kinefab.Advice.Findings;

/// <summary>Joints between bodies whose masses are further apart than 1:10: the worst of each island.</summary>
internal static class UnlikeMasses
{
    public static IEnumerable<AdviceFinding> Find(Examination e)
    {
        var pairs = BodySettings.UnlikeMasses(e.World).ToList();
        if (pairs.Count == 0)
            yield break;
        Change?[] cures = { e.Remedies.MassesScaled, e.Remedies.MassesRaised };
        foreach (Island island in e.Islands)
        {
            var here = pairs.Where(p => island.Joints.Contains(p.Joint.Index)).OrderByDescending(p => p.Ratio).ToList();
            if (here.Count == 0)
                continue;
            (WorldJoint joint, double ratio, WorldBody light, WorldBody heavy) = here[0];
            yield return Suspects.Judge(
                e, island, DiagnosticCodes.AdviceMassesUnlike, EditText.Pointer(joint), joint.Id, cures,
                ("joint", JointSettings.Place(e.Scene, joint)),
                ("light", $"{light.Id} of {AdviceMeasure.Text(light.Settings.Mass)} kg"),
                ("heavy", $"{heavy.Id} of {AdviceMeasure.Text(heavy.Settings.Mass)} kg"),
                ("ratio", ratio.ToString("F0", CultureInfo.InvariantCulture)));
        }
    }
}
