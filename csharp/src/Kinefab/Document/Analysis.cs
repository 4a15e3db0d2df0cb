using System;
using System.Collections.Generic;

namespace Kinefab.Document;

/// <summary>Mobility of the mechanism, as the exporter found it from the source's constraints.</summary>
public sealed class Analysis : DocumentObject
{
    /// <summary>Freedoms of finite motion.</summary>
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
    public IReadOnlyList<Island> Islands { get; init; } = Array.Empty<Island>();

    /// <summary>What each body can still do.</summary>
    public IReadOnlyList<BodyFreedom> Bodies { get; init; } = Array.Empty<BodyFreedom>();
}
