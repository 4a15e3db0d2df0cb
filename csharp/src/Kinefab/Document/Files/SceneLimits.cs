namespace Kinefab.Document;

/// <summary>How much of a file is read before it is refused.  Nothing that a CAD program writes comes near the defaults.</summary>
public sealed class SceneLimits
{
    /// <summary>Default of <see cref="MaxFileBytes"/>: 1 GiB.</summary>
    public const long DefaultMaxFileBytes = 1L << 30;

    /// <summary>Default of <see cref="MaxDepth"/>.</summary>
    public const int DefaultMaxDepth = 64;

    /// <summary>Default of <see cref="MaxItems"/>: 4,194,304.</summary>
    public const int DefaultMaxItems = 1 << 22;

    /// <summary>Default of <see cref="MaxFindings"/>.</summary>
    public const int DefaultMaxFindings = 1000;

    /// <summary>The defaults.</summary>
    public static SceneLimits Default { get; } = new();

    /// <summary>Largest scene file, bytes; looked at before anything is read.</summary>
    public long MaxFileBytes { get; init; } = DefaultMaxFileBytes;

    /// <summary>Most containers inside each other; 256 at most, whatever is asked for, so that what was read can be written again.</summary>
    public int MaxDepth { get; init; } = DefaultMaxDepth;

    /// <summary>Most items of one array.</summary>
    public int MaxItems { get; init; } = DefaultMaxItems;

    /// <summary>Most findings kept, one at least, errors before others; the rest is counted.</summary>
    public int MaxFindings { get; init; } = DefaultMaxFindings;
}
