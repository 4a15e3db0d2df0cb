using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Validation;

namespace Kinefab.Advice.Trials;

/// <summary>Makes changes and runs them, each once, as long as the budget lasts.</summary>
internal sealed class Workbench
{
    /// <summary>Joints times steps times iterations that all trials together may cost: some seconds.</summary>
    public const double MostWork = 1.5e8;

    // Exact runs that may fail before no more are begun: each costs a second.
    private const int MostFailures = 3;

    private readonly Dictionary<string, Trial?> _trials = new(StringComparer.Ordinal);
    private readonly ValidScene _scene;
    private readonly AdviceOptions _options;
    private readonly double _workOfBase;
    private readonly CancellationToken _cancellation;
    private double _work;
    private int _failures;

    public Workbench(ValidScene scene, RunPlan plan, int joints, AdviceOptions options, CancellationToken cancellation)
    {
        _cancellation = cancellation;
        _scene = scene;
        _options = options;
        Plan = plan;
        _workOfBase = WorkPerSecond(scene);
        Joints = joints;
    }

    public RunPlan Plan { get; }

    /// <summary>How many runs were made to try changes and to see what drives hold.</summary>
    public int Count { get; private set; }

    /// <summary>Whether something was left untried for the sake of time.</summary>
    public bool IsSpent { get; private set; }

    private int Joints { get; }

    /// <summary>Unity's run of the changed scene; null when it makes no valid scene, cannot be followed or goes beyond the budget.</summary>
    public Trial? Try(Change change)
    {
        if (!_trials.TryGetValue(change.Kind, out Trial? trial))
        {
            trial = Run(change);
            _trials.Add(change.Kind, trial);
        }

        return trial;
    }

    /// <summary>Steps of a changed scene from one look to the next.</summary>
    public int Substeps(ValidScene scene) => Math.Max(1, (int)Math.Round(Plan.Step / scene.Document.Physics.FixedTimestep));

    /// <summary>The exact run of the scene with parts changed, a step of it counted as one of Unity's; null as for <see cref="Try"/>.</summary>
    /// <param name="what">What is run, for the progress.</param>
    /// <param name="parts">Changes; may be none.</param>
    /// <param name="prepare">Done to the changed scene's world before its first step.</param>
    public SceneRun? RunExact(string what, IEnumerable<ChangePart> parts, Action<ValidScene, World> prepare)
    {
        if (_failures == MostFailures)
        {
            IsSpent = true;
            return null;
        }

        if (Begin(what, parts) is not ValidScene changed)
            return null;
        SceneRun run = SceneRun.Of(changed, SolverKind.Exact, Plan, 1, _cancellation, world => prepare(changed, world));
        _failures += run.IsSound ? 0 : 1;
        return run.IsSound ? run : null;
    }

    private Trial? Run(Change change)
    {
        if (Begin(change.Kind, change.Parts) is not ValidScene changed)
            return null;
        SceneRun run = SceneRun.Of(changed, SolverKind.Unity, Plan, Substeps(changed), _cancellation);
        return run.IsSound ? new Trial(run, WorkPerSecond(changed) / _workOfBase) : null;
    }

    private ValidScene? Begin(string what, IEnumerable<ChangePart> parts)
    {
        if (Count >= _options.MaxTrials || _work > MostWork)
        {
            IsSpent = true;
            return null;
        }

        if (EditedScene.Apply(_scene, parts.SelectMany(p => p.Edits)) is not ValidScene changed)
            return null;
        _options.Progress?.Report(what);
        Count++;
        _work += Math.Max(1, Joints) * Plan.Seconds * WorkPerSecond(changed);
        return changed;
    }

    private static double WorkPerSecond(ValidScene scene)
    {
        Physics physics = scene.Document.Physics;
        int iterations = 1;
        for (int i = 0; i < scene.Document.GameObjects.Count; i++)
        {
            if (scene.Body(i) is Rigidbody body)
                iterations = Math.Max(iterations, (body.SolverIterations ?? physics.SolverIterations) + (body.SolverVelocityIterations ?? physics.SolverVelocityIterations));
        }

        return iterations / physics.FixedTimestep;
    }
}

/// <summary>A change that was run.</summary>
internal sealed class Trial
{
    public Trial(SceneRun run, double work)
    {
        Run = run;
        Work = work;
    }

    public SceneRun Run { get; }

    /// <summary>Work a second, the unchanged scene's being 1.</summary>
    public double Work { get; }
}
