using System;

namespace Kinefab.Document;

/// <summary>How a scene file is read.</summary>
public sealed class SceneReadOptions
{
    /// <summary>Unknown fields are warnings, limits are the default ones.</summary>
    public static SceneReadOptions Default { get; } = new();

    /// <summary>Unknown fields are errors.</summary>
    public bool Strict { get; init; }

    /// <summary>How much is read at most.</summary>
    public SceneLimits Limits { get; init; } = SceneLimits.Default;

    /// <summary>Told the share of the loading that is done, 0 to 1 and rising; null: nobody is.</summary>
    public IProgress<double>? Progress { get; init; }
}
