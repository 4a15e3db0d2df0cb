using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;
using Kinefab.Validation;

namespace Kinefab.Advice.Findings;

/// <summary>Springs that still swing their joint to and fro in the last half of Unity's run, and the damper that stops them.</summary>
internal static class RingingDrives
{
    // Crossings of the middle that make a swing of it.
    private const int FewestCrossings = 4;

    // Times the critical damper.
    private static readonly int[] Dampers = { 1, 2, 4 };

    public static IEnumerable<AdviceFinding> Find(Examination e)
    {
        foreach (DriveSite site in DriveSite.Of(e.Scene, e.World).Where(s => s.Spring > 0))
        {
            if (e.Islands.FirstOrDefault(i => i.Joints.Contains(site.Joint.Index)) is not Island island)
                continue;
            JointRecord record = e.Unity.Joints[site.Joint.Index];
            Threshold threshold = Threshold.Hold(island);
            for (int f = 0; f < record.Freedoms.Count; f++)
            {
                int freedom = f;
                AdviceMeasure before = Swing(e.Unity);
                double score = threshold.Score(before);
                double period = Period(record.Coordinates[f]) * e.Plan.Step;
                if (!site.Coordinates.Contains(record.Freedoms[f].Coordinate) || score < 1 || period <= 0)
                    continue;

                // Critical damping of what swings with this period on this spring: d = 2 k / omega.
                double damper = site.Spring * period / Math.PI;
                Change[] ladder = Dampers.Where(n => n * damper > site.Damper)
                    .Select(n => new Change($"{site.Pointer}/damper {n}", new[] { site.WithDamper(n * damper) })).ToArray();
                var treatment = Treatment.Of(e, island, Swing, threshold, new[] { ladder, e.Remedies.SmallerSteps });
                yield return FindingText.Make(
                    DiagnosticCodes.AdviceDriveRings, Severity.Warning, site.Pointer, site.Joint.Id, before, score, treatment,
                    ("drive", site.Label), ("joint", site.Place), ("measure", before.ToString()),
                    ("period", AdviceMeasure.Text(period)), ("steps", AdviceMeasure.Text(period / e.Plan.Step)));

                AdviceMeasure Swing(SceneRun run)
                {
                    JointRecord joint = run.Joints[site.Joint.Index];
                    double[] late = Late(joint.Coordinates[freedom]);
                    return JointRecord.Of(joint.Freedoms[freedom], (late.Max() - late.Min()) / 2);
                }
            }
        }
    }

    /// <summary>Samples from one swing to the next; 0 where there are too few.</summary>
    private static double Period(double[] values)
    {
        double[] late = Late(values);
        double middle = (late.Max() + late.Min()) / 2;
        List<int> crossings = Enumerable.Range(1, late.Length - 1).Where(k => (late[k] > middle) != (late[k - 1] > middle)).ToList();
        return crossings.Count < FewestCrossings ? 0 : 2.0 * (crossings[crossings.Count - 1] - crossings[0]) / (crossings.Count - 1);
    }

    private static double[] Late(double[] values) => values.Skip(values.Length / 2).ToArray();
}
