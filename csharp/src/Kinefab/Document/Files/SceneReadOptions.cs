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
}
