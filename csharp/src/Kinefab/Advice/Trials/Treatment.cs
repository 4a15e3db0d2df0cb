using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;

namespace Kinefab.Advice.Trials;

/// <summary>Tries changes against one finding and chooses among them by what they came to.</summary>
internal sealed class Treatment
{
    // A change that leaves more than this of the trouble does not count as help.
    private const double Help = 0.8;

    // A change may not leave more than this of the drift or of the wrong motion that there was, nor more than is worth a warning.
    private const double Harm = 1.1;

    private readonly Examination _examination;
    private readonly RunIsland _island;
    private readonly Func<SceneRun, AdviceMeasure> _measure;
    private readonly Threshold _threshold;
    private readonly double _before;
    private readonly double _drift;
    private readonly double _place;
    private readonly List<(Change Change, TriedChange Tried, bool IsHarmless)> _tried = new();

    private Treatment(Examination examination, RunIsland island, Func<SceneRun, AdviceMeasure> measure, Threshold threshold)
    {
        _examination = examination;
        _island = island;
        _measure = measure;
        _threshold = threshold;
        _before = threshold.Score(measure(examination.Unity));
        _drift = Drift(examination.Unity);
        _place = Place(examination.Unity);
    }

    public IReadOnlyList<TriedChange> Tried => _tried.Select(t => t.Tried).ToArray();

    /// <summary>Enough at the least work, else the most helpful one; null: none helps.</summary>
    public TriedChange? Best => Chosen()?.Tried;

    /// <summary>Tries ladders of changes.</summary>
    /// <param name="examination">The scene.</param>
    /// <param name="island">Where the finding stands.</param>
    /// <param name="measure">What it measures in a run.</param>
    /// <param name="threshold">What of that is worth a warning.</param>
    /// <param name="ladders">Changes; in each ladder from the cheapest upwards.</param>
    public static Treatment Of(Examination examination, RunIsland island, Func<SceneRun, AdviceMeasure> measure, Threshold threshold, IEnumerable<Change[]> ladders)
    {
        var treatment = new Treatment(examination, island, measure, threshold);
        foreach (Change[] ladder in ladders)
        {
            foreach (Change change in ladder)
            {
                if (treatment.Try(change) is TriedChange tried && tried.Score < 1)
                    break;
            }
        }

        if (treatment.Best is { Score: >= 1 })
            treatment.TryTogether();
        return treatment;
    }

    // The two that help most, where neither is enough; two of one ladder do not add up.
    private void TryTogether()
    {
        (Change Change, TriedChange Tried, bool)[] helpful = _tried.Where(t => t.IsHarmless && t.Tried.Score < Help * _before)
            .OrderBy(t => t.Tried.Score).GroupBy(t => t.Change.Kind.Split(' ')[0]).Select(g => g.First()).Take(2).ToArray();
        if (helpful.Length == 2)
            Try(Change.Both(helpful[0].Change, helpful[1].Change));
    }

    private TriedChange? Try(Change change)
    {
        IReadOnlyList<ChangePart> parts = change.In(_island);
        if (parts.Count == 0 || _examination.Workbench.Try(change) is not Trial trial)
            return null;
        AdviceMeasure after = _measure(trial.Run);
        var tried = new TriedChange(Change.Words(parts), parts.SelectMany(p => p.Edits).ToArray(), after, _threshold.Score(after), trial.Work);
        bool isHarmless = Drift(trial.Run) <= Math.Max(1, Harm * _drift)
            && (change.AltersMotion || Place(trial.Run) <= Math.Max(1, Harm * _place));
        _tried.Add((change, tried, isHarmless));
        return tried;
    }

    private (Change Change, TriedChange Tried, bool)? Chosen()
    {
        (Change Change, TriedChange Tried, bool)[] good = _tried.Where(t => t.IsHarmless && t.Tried.Score < Help * _before)
            .OrderBy(t => t.Tried.Score < 1 ? 0 : 1)
            .ThenBy(t => t.Tried.Score < 1 ? t.Tried.Work : 0)
            .ThenBy(t => t.Tried.Score)
            .ToArray();
        return good.Length == 0 ? null : good[0];
    }

    private double Drift(SceneRun run) => Threshold.Drift(_island).Score(_examination.WorstDrift(run, _island).Measure);

    private double Place(SceneRun run) => Threshold.Place(_island).Score(_examination.WorstPlace(run, _island).Measure);
}
