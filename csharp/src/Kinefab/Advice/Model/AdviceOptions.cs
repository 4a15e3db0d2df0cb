using System;

namespace Kinefab.Advice;

/// <summary>How much is simulated for the sake of advice. Limits are counted, never clocked, so that the same file gives the same advice.</summary>
public sealed class AdviceOptions
{
    /// <summary>Seconds to simulate, positive and finite; null: 2, and less in scenes of many joints.</summary>
    public double? Seconds { get; init; }

    /// <summary>Runs to make at most beside the scene's own: of changes, and of poses held to see which drives are weak.</summary>
    public int MaxTrials { get; init; } = 60;

    /// <summary>Told what is being run, before each run; null: nobody is.</summary>
    public IProgress<string>? Progress { get; init; }
}
