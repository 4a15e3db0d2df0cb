using System.Collections.Generic;
using System.Diagnostics;
using Kinefab.Diagnostics;

namespace Kinefab.Advice;

/// <summary>Something about a scene that Unity's solver makes trouble of, or might, and what was tried against it.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class AdviceFinding
{
    internal AdviceFinding(Diagnostic diagnostic, string id, AdviceMeasure before, double score, IReadOnlyList<TriedChange> tried, TriedChange? best)
    {
        Diagnostic = diagnostic;
        Id = id;
        Before = before;
        Score = score;
        Tried = tried;
        Best = best;
    }

    /// <summary>Code, place and words; a warning where something was measured, an info where nothing comes of it.</summary>
    public Diagnostic Diagnostic { get; }

    /// <summary>Id of the GameObject meant.</summary>
    public string Id { get; }

    /// <summary>What the scene as it stands measures.</summary>
    public AdviceMeasure Before { get; }

    /// <summary><see cref="Before"/> in units of what is worth a warning.</summary>
    public double Score { get; }

    /// <summary>In the order they were tried.</summary>
    public IReadOnlyList<TriedChange> Tried { get; }

    /// <summary>The one to make: enough at the least work, or else the one that helps most; null: none helps.</summary>
    public TriedChange? Best { get; }

    /// <summary>Severity, code, place, what was found and measured, and the change to make, in one line.</summary>
    public override string ToString() => $"{Diagnostic.Severity.ToJson()} {Diagnostic.Code} {Diagnostic.Pointer}: {Diagnostic.Message} ({Before}){(Best is null ? "" : $" {Best}")}";
}
