using System;
using System.Collections.Generic;

namespace Kinefab.Document;

/// <summary>Bodies that hang together by joints, the ground left out.</summary>
public sealed partial record AnalysisIsland : DocumentObject
{
    /// <summary>Indices of GameObjects.</summary>
    [Field(Required = true)]
    public IReadOnlyList<int> GameObjects { get; init; } = Array.Empty<int>();

    /// <summary>Freedoms of finite motion.</summary>
    [Field(Required = true)]
    public int Mobility { get; init; }

    /// <summary>Rows that remove nothing; null: not stated.</summary>
    public int? Redundant { get; init; }

    /// <summary>Closed loops; null: not stated.</summary>
    public int? Loops { get; init; }
}
