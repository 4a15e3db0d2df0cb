using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Advice.Findings;

/// <summary>
/// Drives whose largest force cannot hold the mechanism up: each is told to hold the exported pose and the exact solver shows
/// how far it sinks, beside how far it would sink by its spring alone. Forces are doubled until they hold.
/// </summary>
internal static class WeakDrives
{
    // Unity's own largest number stands for no limit.
    private const double Unlimited = 3.4e38;
    private const int MostDoublings = 12;

    public static IEnumerable<AdviceFinding> Find(Examination e)
    {
        DriveSite[] sites = DriveSite.Of(e.Scene, e.World).Where(s => s.Force < 0.1 * Unlimited).ToArray();
        if (sites.Length == 0 || e.World.Gravity == Vector3d.Zero)
            return Array.Empty<AdviceFinding>();
        ILookup<int, DriveSite> sitesOf = sites.ToLookup(s => s.Joint.Index);
        (DriveSite Site, Island Island)[] placed = e.Islands.SelectMany(i => i.Joints.SelectMany(j => sitesOf[j]).Select(s => (s, i))).ToArray();
        SceneRun? asIs = Hold(e, Array.Empty<ChangePart>());
        SceneRun? strong = Hold(e, sites.Select(s => s.WithForce(Unlimited)));
        if (asIs is null || strong is null)
            return Array.Empty<AdviceFinding>();
        placed = placed.Where(p => !Holds(asIs, p.Site, p.Island)).ToArray();
        var findings = new List<AdviceFinding>();
        var forces = placed.ToDictionary(p => p.Site, p => p.Site.Force);
        var tried = placed.ToDictionary(p => p.Site, _ => new List<TriedChange>());
        SceneRun? last = asIs;
        for (int n = 0; n < MostDoublings && last is not null && placed.Any(p => !Holds(last, p.Site, p.Island)); n++)
        {
            foreach ((DriveSite site, Island island) in placed.Where(p => !Holds(last, p.Site, p.Island)))
                forces[site] *= 2;
            last = Hold(e, placed.Select(p => p.Site.WithForce(forces[p.Site])));
            foreach ((DriveSite site, Island island) in placed.Where(_ => last is not null))
            {
                ChangePart[] parts = placed.Where(p => p.Island == island).Select(p => p.Site.WithForce(forces[p.Site])).ToArray();
                AdviceMeasure after = Sinking(last!, site);
                tried[site].Add(new TriedChange(Change.Words(parts), parts.SelectMany(p => p.Edits).ToArray(), after, Score(last!, site, island), 1));
            }
        }

        foreach ((DriveSite site, Island island) in placed)
        {
            AdviceMeasure before = Sinking(asIs, site);
            TriedChange? best = tried[site].Find(t => t.Score < 1);
            findings.Add(FindingText.Make(
                DiagnosticCodes.AdviceDriveWeak, Severity.Warning, site.Pointer, site.Joint.Id, before, Score(asIs, site, island), tried[site], best,
                ("drive", site.Label), ("joint", site.Place), ("measure", before.ToString()),
                ("force", $"{EditText.Number(site.Force)} {(site.IsAngular ? "N m" : "N")}"), ("seconds", AdviceMeasure.Text(e.Plan.Seconds))));
        }

        return findings;

        bool Holds(SceneRun run, DriveSite site, Island island) => Score(run, site, island) < 1;

        // What a spring gives way by is its own affair.
        double Score(SceneRun run, DriveSite site, Island island) =>
            Threshold.Hold(island).Score(Sinking(run, site)) - Threshold.Hold(island).Score(Sinking(strong, site));
    }

    private static SceneRun? Hold(Examination e, IEnumerable<ChangePart> parts)
    {
        if (EditedScene.Apply(e.Scene, parts.SelectMany(p => p.Edits)) is not ValidScene scene)
            return null;
        SceneRun run = SceneRun.Of(scene, SolverKind.Exact, e.Plan, 1, world =>
        {
            foreach (DriveSite site in DriveSite.Of(scene, world))
            {
                foreach (Document.Coordinate coordinate in site.Coordinates)
                {
                    if (site.Spring > 0)
                        site.Joint.DriveTo(coordinate, 0);
                    else
                        site.Joint.DriveAt(coordinate, 0);
                }
            }
        });
        return run.IsSound ? run : null;
    }

    // The furthest way from the exported pose.
    private static AdviceMeasure Sinking(SceneRun run, DriveSite site)
    {
        JointRecord record = run.Joints[site.Joint.Index];
        AdviceMeasure worst = default;
        for (int i = 0; i < record.Freedoms.Count; i++)
        {
            JointFreedom freedom = record.Freedoms[i];
            if (site.Coordinates.Contains(freedom.Coordinate))
                worst = AdviceMeasure.Max(worst, JointRecord.Of(freedom, record.Coordinates[i].Max(Math.Abs)));
        }

        return worst;
    }
}
