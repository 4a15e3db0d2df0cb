using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Validation;

namespace Kinefab.Advice.Findings;

/// <summary>The drives of an island that are told to hold the exported pose, and how far they sink from it.</summary>
internal sealed class HeldPose
{
    private readonly SceneRun _strong;
    private readonly DriveSite[] _sites;
    private readonly double[] _forces;
    private readonly List<TriedChange> _tried = new();

    /// <param name="island">Whose drives they are.</param>
    /// <param name="sites">Those of limited force, one or more.</param>
    /// <param name="strong">The pose held with unlimited forces.</param>
    public HeldPose(RunIsland island, DriveSite[] sites, SceneRun strong)
    {
        Island = island;
        _sites = sites;
        _strong = strong;
        _forces = Array.ConvertAll(sites, s => s.Force);
        Parts = Array.Empty<ChangePart>();
    }

    public RunIsland Island { get; }

    /// <summary>The forces raised so far.</summary>
    public IReadOnlyList<ChangePart> Parts { get; private set; }

    public IReadOnlyList<TriedChange> Tried => _tried;

    /// <summary>The drive that sinks furthest, how far, and that in units of what is worth a warning.</summary>
    public (DriveSite Site, AdviceMeasure Sinking, double Score) Worst(SceneRun run)
    {
        DriveSite worst = _sites[0];
        foreach (DriveSite site in _sites)
        {
            if (Score(run, site) > Score(run, worst))
                worst = site;
        }

        return (worst, Sinking(run, worst), Score(run, worst));
    }

    /// <summary>How many drives do not hold.</summary>
    public int Weak(SceneRun run) => _sites.Count(s => Score(run, s) >= 1);

    /// <summary>Doubles the forces that do not hold.</summary>
    public void Raise(SceneRun run)
    {
        for (int i = 0; i < _sites.Length; i++)
            _forces[i] *= Score(run, _sites[i]) >= 1 ? 2 : 1;
        Parts = Enumerable.Range(0, _sites.Length).Where(i => _forces[i] > _sites[i].Force).Select(i => _sites[i].WithForce(_forces[i])).ToArray();
    }

    /// <summary>Takes note of what the forces raised come to.</summary>
    public void Note(SceneRun run)
    {
        (_, AdviceMeasure after, double score) = Worst(run);
        _tried.Add(new TriedChange(Change.Words(Parts), Parts.SelectMany(p => p.Edits).ToArray(), after, score, 1));
    }

    // What a spring gives way by is its own affair.
    private double Score(SceneRun run, DriveSite site)
    {
        Threshold threshold = Threshold.Hold(Island);
        return threshold.Score(Sinking(run, site)) - threshold.Score(Sinking(_strong, site));
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
