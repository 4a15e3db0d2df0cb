using System.Collections.Generic;
using System.Diagnostics;

namespace Kinefab.Advice;

/// <summary>A change of the scene that was made and run, with what it came to.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class TriedChange
{
    internal TriedChange(string change, IReadOnlyList<SceneEdit> edits, AdviceMeasure after, double score, double work)
    {
        Change = change;
        Edits = edits;
        After = after;
        Score = score;
        Work = work;
    }

    /// <summary>What to do in Unity, in words.</summary>
    public string Change { get; }

    /// <summary>The same as fields of the scene file: applied to it, they give <see cref="After"/> again.</summary>
    public IReadOnlyList<SceneEdit> Edits { get; }

    /// <summary>What the finding measures with the change made.</summary>
    public AdviceMeasure After { get; }

    /// <summary><see cref="After"/> in units of what is worth a warning.</summary>
    public double Score { get; }

    /// <summary>Work of Unity's solver for a second simulated, in units of the scene's own.</summary>
    public double Work { get; }

    /// <summary>The change in words, and what the finding measures with it.</summary>
    public override string ToString() => $"{Change}: {After}{Cost}";

    /// <summary>What the work comes to in words; empty where it is the same.</summary>
    internal string Cost => Work == 1 ? "" : $", at {AdviceMeasure.Text(Work)} times the work";
}
