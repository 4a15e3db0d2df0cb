using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Advice.Trials;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using Island = Kinefab.Advice.Runs.RunIsland;

namespace Kinefab.Advice.Findings;

/// <summary>
/// Drives whose largest force cannot hold the mechanism up, the worst of each island: all are told to hold the exported pose
/// and the exact solver shows how far they sink, beside how far by their springs alone. Forces are doubled until they hold.
/// </summary>
internal static class WeakDrives
{
    // Unity's own largest number stands for no limit.
    private const double Unlimited = 3.4e38;
    private const int MostDoublings = 12;

    public static IEnumerable<AdviceFinding> Find(Examination e)
    {
        DriveSite[] sites = DriveSite.Of(e.Scene, e.World).Where(s => s.Force < 0.1 * Unlimited).ToArray();
        if (sites.Length == 0 || e.World.Gravity == Vector3d.Zero
            || Hold(e, "drives", Array.Empty<ChangePart>()) is not SceneRun asIs
            || Hold(e, "drives unlimited", sites.Select(s => s.WithForce(Unlimited))) is not SceneRun strong)
            return Array.Empty<AdviceFinding>();
        ILookup<int, DriveSite> sitesOf = sites.ToLookup(s => s.Joint.Index);
        Dictionary<RunIsland, HeldPose> held = e.Islands.Where(i => i.Joints.Any(sitesOf.Contains))
            .ToDictionary(i => i, i => new HeldPose(i, i.Joints.SelectMany(j => sitesOf[j]).ToArray(), strong));
        HeldPose[] weak = e.WorstFirst(held.Keys, i => held[i].Worst(asIs).Score, least: 1).Select(i => held[i]).ToArray();
        SceneRun last = asIs;
        for (int n = 1; n <= MostDoublings && weak.Any(h => h.Weak(last) > 0); n++)
        {
            foreach (HeldPose pose in weak)
                pose.Raise(last);
            if (Hold(e, $"drives doubled {n}", weak.SelectMany(h => h.Parts)) is not SceneRun run)
                break;
            last = run;
            foreach (HeldPose pose in weak)
                pose.Note(last);
        }

        return weak.Select(h => Finding(e, h, asIs)).ToArray();
    }

    private static AdviceFinding Finding(Examination e, HeldPose held, SceneRun asIs)
    {
        (DriveSite site, AdviceMeasure before, double score) = held.Worst(asIs);
        int others = held.Weak(asIs) - 1;
        return FindingText.Make(
            DiagnosticCodes.AdviceDriveWeak, Severity.Warning, site.Pointer, site.Joint.Id, before, score, held.Tried, held.Tried.FirstOrDefault(t => t.Score < 1),
            ("drive", site.Label), ("joint", site.Place), ("measure", before.ToString()),
            ("force", $"{EditText.Number(site.Force)} {(site.IsAngular ? "N m" : "N")}"), ("seconds", AdviceMeasure.Text(e.Plan.Seconds)),
            ("others", others == 0 ? "" : $"; so {(others == 1 ? "does" : "do")} {others} more of its mechanism"));
    }

    private static SceneRun? Hold(Examination e, string what, IEnumerable<ChangePart> parts) => e.Workbench.RunExact(what, parts, (scene, world) =>
    {
        foreach (DriveSite site in DriveSite.Of(scene, world))
        {
            foreach (Coordinate coordinate in site.Coordinates)
            {
                if (site.Spring > 0)
                    site.Joint.DriveTo(coordinate, 0);
                else
                    site.Joint.DriveAt(coordinate, 0);
            }
        }
    });
}
