using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;
using Kinefab.Validation;

namespace Kinefab.Advice.Findings;

/// <summary>Springs that still swing their joint to and fro in the last half of Unity's run, and the dampers that stop them: the worst of each island.</summary>
internal static class RingingDrives
{
    // Crossings of the middle that make a swing of it.
    private const int FewestCrossings = 4;

    // Times the critical damper.
    private static readonly int[] Dampers = { 1, 2, 4 };

    public static IEnumerable<AdviceFinding> Find(Examination e)
    {
        ILookup<int, DriveSite> springs = DriveSite.Of(e.Scene, e.World).Where(s => s.Spring > 0).ToLookup(s => s.Joint.Index);
        foreach (RunIsland island in e.WorstFirst(i => Ringing(e, i, springs).Select(d => Threshold.Hold(i).Score(Swing(e.Unity, d))).FirstOrDefault()))
        {
            Threshold threshold = Threshold.Hold(island);
            DriveSite[] sites = island.Joints.SelectMany(j => springs[j]).ToArray();
            (DriveSite Site, int Freedom)[] ringing = Ringing(e, island, springs);

            DriveSite worst = ringing[0].Site;
            AdviceMeasure before = Measure(e.Unity);
            double period = Period(Values(e.Unity, ringing[0])) * e.Plan.Step;
            var treatment = Treatment.Of(e, island, Measure, threshold, new[] { Damped(sites, worst, period), e.Remedies.SmallerSteps });
            yield return FindingText.Make(
                DiagnosticCodes.AdviceDriveRings, Severity.Warning, worst.Pointer, worst.Joint.Id, before, threshold.Score(before), treatment,
                ("drive", worst.Label), ("joint", worst.Place), ("measure", before.ToString()),
                ("period", AdviceMeasure.Text(period)), ("steps", AdviceMeasure.Text(period / e.Plan.Step)));

            AdviceMeasure Measure(SceneRun run) => ringing.Select(d => Swing(run, d)).Aggregate(AdviceMeasure.Max);
        }
    }

    // Those that go to and fro, widest first.
    private static (DriveSite Site, int Freedom)[] Ringing(Examination e, RunIsland island, ILookup<int, DriveSite> springs) => island.Joints
        .SelectMany(j => springs[j]).SelectMany(s => Driven(e, s))
        .Where(d => Period(Values(e.Unity, d)) > 0)
        .OrderByDescending(d => Threshold.Hold(island).Score(Swing(e.Unity, d)))
        .ToArray();

    // Critical damping of what swings with this period: d = 2 k / omega for each spring k that has less.
    private static Change[] Damped(DriveSite[] sites, DriveSite worst, double period) => Dampers
        .Select(n => new Change(
            $"{worst.Pointer} damped {n}",
            sites.Where(s => s.Damper < n * s.Spring * period / Math.PI).Select(s => s.WithDamper(n * s.Spring * period / Math.PI)),
            altersMotion: true))
        .Where(c => c.Parts.Count > 0)
        .ToArray();

    private static IEnumerable<(DriveSite Site, int Freedom)> Driven(Examination e, DriveSite site)
    {
        IReadOnlyList<JointFreedom> freedoms = e.Unity.Joints[site.Joint.Index].Freedoms;
        return Enumerable.Range(0, freedoms.Count).Where(f => site.Coordinates.Contains(freedoms[f].Coordinate)).Select(f => (site, f));
    }

    private static AdviceMeasure Swing(SceneRun run, (DriveSite Site, int Freedom) driven)
    {
        double[] late = Values(run, driven);
        return JointRecord.Of(run.Joints[driven.Site.Joint.Index].Freedoms[driven.Freedom], (late.Max() - late.Min()) / 2);
    }

    private static double[] Values(SceneRun run, (DriveSite Site, int Freedom) driven)
    {
        double[] values = run.Joints[driven.Site.Joint.Index].Coordinates[driven.Freedom];
        return values.Skip(values.Length / 2).ToArray();
    }

    // Samples from one swing to the next; 0 where there are too few.
    private static double Period(double[] values)
    {
        double middle = (values.Max() + values.Min()) / 2;
        List<int> crossings = Enumerable.Range(1, values.Length - 1).Where(k => (values[k] > middle) != (values[k - 1] > middle)).ToList();
        return crossings.Count < FewestCrossings ? 0 : 2.0 * (crossings[crossings.Count - 1] - crossings[0]) / (crossings.Count - 1);
    }
}
