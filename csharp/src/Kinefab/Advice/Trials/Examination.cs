using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Kinefab.Advice.Runs;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Validation;

namespace Kinefab.Advice.Trials;

/// <summary>A scene as it stands, run under both solvers, and the changes that may be tried on it.</summary>
internal sealed class Examination
{
    private const double StandardSeconds = 2;
    private const int FewestSamples = 10;

    // How long the unchanged scene is run, in joints and bodies times steps, and how much longer where seconds are asked for.
    private const double MostSteps = 200_000;
    private const double Patience = 10;

    // Where the exact motion at the step and at half of it differ by more than this share of what is worth a warning, nothing
    // can be foretold any more: the mechanism is chaotic.
    private const double Foretold = 0.1;

    // Findings of one kind that are listed.
    private const int MostOfAKind = 10;

    // Loops are not looked at in larger scenes.
    private const int MostJointsCounted = 2000;

    // Fewer samples than these say nothing about a motion.
    private const int FewestForeseen = 10;

    public Examination(ValidScene scene, AdviceOptions options, CancellationToken cancellation)
    {
        Scene = scene;
        World = World.Create(scene, cancellation: cancellation);
        double step = scene.Document.Physics.FixedTimestep;
        double wanted = Math.Max(FewestSamples, Math.Round((options.Seconds ?? StandardSeconds) / step));
        double most = (options.Seconds is null ? 1 : Patience) * MostSteps / Math.Max(1, World.Joints.Count + World.Bodies.Count);
        Plan = new RunPlan(step, (int)Math.Max(FewestSamples, Math.Min(wanted, Math.Floor(most))));
        IsShortened = Plan.Samples < wanted;
        options.Progress?.Report("unity");
        Unity = SceneRun.Of(scene, SolverKind.Unity, Plan, 1, cancellation);
        options.Progress?.Report("exact");
        Exact = SceneRun.Of(scene, SolverKind.Exact, Plan, 1, cancellation);
        SceneRun half = Exact.IsSound ? SceneRun.Of(scene, SolverKind.Exact, Plan, 2, cancellation) : Exact;
        ExactTrouble = half.Trouble;
        Islands = RunIsland.Of(World, scene.Document.Couplings);
        Foreseen = Islands.Select(i => Exact.IsSound && half.IsSound ? Horizon(i, half) : 0).ToArray();
        Workbench = new Workbench(scene, Plan, World.Joints.Count, options, cancellation);
        Mechanism? mechanism = World.Joints.Count <= MostJointsCounted ? Mechanism.Create(scene) : null;
        Mobility = mechanism is null ? null : MobilityAnalysis.Of(mechanism, null, cancellation);
        Remedies = new Remedies(scene, World, Islands, Unity, mechanism, Mobility, cancellation);
    }

    public ValidScene Scene { get; }

    /// <summary>At its start, never moved.</summary>
    public World World { get; }

    public RunPlan Plan { get; }

    /// <summary>Whether the scene is too large for the time asked for.</summary>
    public bool IsShortened { get; }

    public SceneRun Unity { get; }

    public SceneRun Exact { get; }

    /// <summary>Why the exact run, or that at half the step, ended early; else empty.</summary>
    public string ExactTrouble { get; }

    /// <summary>Null in a scene of too many joints to count rows in.</summary>
    public MobilityReport? Mobility { get; }

    public IReadOnlyList<RunIsland> Islands { get; }

    /// <summary>For each island the number of samples up to which its exact motion is known.</summary>
    public IReadOnlyList<int> Foreseen { get; }

    public Workbench Workbench { get; }

    /// <summary>Findings left out, since there are worse ones of the same kind.</summary>
    public int Omitted { get; private set; }

    public Remedies Remedies { get; }

    /// <summary>The islands to speak of for one kind of finding, worst first.</summary>
    /// <param name="score">How bad an island is.</param>
    /// <param name="least">How bad it must be.</param>
    public IReadOnlyList<RunIsland> WorstFirst(Func<RunIsland, double> score, double least = 1) => WorstFirst(Islands, score, least);

    public IReadOnlyList<RunIsland> WorstFirst(IEnumerable<RunIsland> islands, Func<RunIsland, double> score, double least)
    {
        RunIsland[] bad = islands.Select(i => (Island: i, Score: score(i))).Where(i => i.Score >= least).OrderByDescending(i => i.Score).Select(i => i.Island).ToArray();
        Omitted += Math.Max(0, bad.Length - MostOfAKind);
        return bad.Take(MostOfAKind).ToArray();
    }

    /// <summary>The joint of an island that comes apart most, and how far.</summary>
    public (WorldJoint Joint, AdviceMeasure Measure) WorstDrift(SceneRun run, RunIsland island) => Worst(run, island, r => r.Drift);

    /// <summary>The joint of an island with the worst of some measure.</summary>
    public (WorldJoint Joint, AdviceMeasure Measure) Worst(SceneRun run, RunIsland island, Func<JointRecord, AdviceMeasure> of)
    {
        Threshold threshold = Threshold.Drift(island);
        int worst = island.Joints[0];
        foreach (int j in island.Joints)
        {
            if (threshold.Score(of(run.Joints[j])) > threshold.Score(of(run.Joints[worst])))
                worst = j;
        }

        return (World.Joints[worst], of(run.Joints[worst]));
    }

    /// <summary>The body of an island that is furthest from its exact motion, and how far.</summary>
    public (WorldBody Body, AdviceMeasure Measure) WorstPlace(SceneRun run, RunIsland island)
    {
        Threshold threshold = Threshold.Place(island);
        AdviceMeasure[] all = new Deviation(run, Exact, island, World.Bodies).Worst(Foreseen[island.Index]);
        int worst = 0;
        for (int i = 1; i < all.Length; i++)
        {
            if (threshold.Score(all[i]) > threshold.Score(all[worst]))
                worst = i;
        }

        return (World.Bodies[island.Bodies[worst]], all[worst]);
    }

    private int Horizon(RunIsland island, SceneRun half)
    {
        Threshold threshold = Threshold.Place(island);
        var deviation = new Deviation(Exact, half, island, World.Bodies);
        for (int k = 0; k < Plan.Samples; k++)
        {
            if (deviation.At(k).Any(m => threshold.Score(m) > Foretold))
                return k < FewestForeseen ? 0 : k;
        }

        return Plan.Samples;
    }
}
