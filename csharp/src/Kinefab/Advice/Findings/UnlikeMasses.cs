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
        var pairs = BodySettings.UnlikeMasses(e.World).ToDictionary(p => p.Joint.Index);
        Change?[] cures = { e.Remedies.MassesScaled, e.Remedies.MassesRaised };
        foreach (RunIsland island in Suspects.Islands(e, i => i.Joints.Any(pairs.ContainsKey)))
        {
            (WorldJoint joint, double ratio, WorldBody light, WorldBody heavy) = island.Joints.Where(pairs.ContainsKey).Select(j => pairs[j]).OrderByDescending(p => p.Ratio).First();
            yield return Suspects.Judge(
                e, island, DiagnosticCodes.AdviceMassesUnlike, EditText.Pointer(joint), joint.Id, cures,
                ("joint", JointSettings.Place(e.Scene, joint)),
                ("light", $"{light.Id} of {AdviceMeasure.Text(light.Settings.Mass)} kg"),
                ("heavy", $"{heavy.Id} of {AdviceMeasure.Text(heavy.Settings.Mass)} kg"),
                ("ratio", ratio.ToString("F0", CultureInfo.InvariantCulture)));
        }
    }
}
