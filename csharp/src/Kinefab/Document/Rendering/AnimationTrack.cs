using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>Local transforms of one GameObject at the clip's times.</summary>
public sealed partial record AnimationTrack : DocumentObject
{
    /// <summary>Index of the GameObject.</summary>
    [Field(Required = true)]
    public int GameObject { get; init; }

    /// <summary>One for each time, metres; empty: it does not move.</summary>
    public IReadOnlyList<Vector3d> LocalPosition { get; init; } = Array.Empty<Vector3d>();

    /// <summary>One for each time; empty: it does not turn.</summary>
    public IReadOnlyList<Quaterniond> LocalRotation { get; init; } = Array.Empty<Quaterniond>();
}
