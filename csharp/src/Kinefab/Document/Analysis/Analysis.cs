using System;
using System.Collections.Generic;
using Kinefab.Json;

namespace Kinefab.Document;

/// <summary>Mobility of the mechanism, as the exporter found it from the source's constraints.</summary>
public sealed partial record Analysis : DocumentObject
{
    /// <summary>Freedoms of finite motion.</summary>
    [Field(Required = true)]
    public int Mobility { get; init; }

    /// <summary>Freedoms of the velocities at the exported pose; null: not stated.</summary>
    public int? FirstOrderMobility { get; init; }

    /// <summary>Constraint rows that remove nothing at the exported pose; null: not stated.</summary>
    public int? Redundant { get; init; }

    /// <summary>Freedoms of single bodies that move nothing else; null: not stated.</summary>
    public int? Idle { get; init; }

    /// <summary>Worst misfit of the exported pose; null: not stated.</summary>
    public ClosureGap? ClosureGap { get; init; }

    /// <summary>Bodies that hang together by joints.</summary>
    [Field(Always = true)]
    public IReadOnlyList<AnalysisIsland> Islands { get; init; } = Array.Empty<AnalysisIsland>();

    /// <summary>What each body can still do.</summary>
    [Field(Always = true)]
    public IReadOnlyList<BodyFreedom> Bodies { get; init; } = Array.Empty<BodyFreedom>();

    private protected override string Describe() => $"mobility {Mobility}, {Invariant.Counted(Islands.Count, "island")}, {Invariant.Counted(Bodies.Count, "body", "bodies")}";
}
