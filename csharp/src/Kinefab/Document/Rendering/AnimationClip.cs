using System;
using System.Collections.Generic;
using Kinefab.Json;

namespace Kinefab.Document;

/// <summary>What a clip does at its end.</summary>
[Words]
public enum WrapMode
{
    /// <summary>Stops.</summary>
    Once,

    /// <summary>Starts again.</summary>
    Loop,

    /// <summary>Runs backwards.</summary>
    PingPong,
}

/// <summary>An animation, linear between keys.</summary>
public sealed partial record AnimationClip : DocumentObject
{
    /// <summary>Its name.</summary>
    [Field(Required = true)]
    public string Name { get; init; } = "";

    /// <summary>Seconds, rising.</summary>
    [Field(Required = true, Least = 1)]
    public IReadOnlyList<double> Times { get; init; } = Array.Empty<double>();

    /// <summary>What it does at its end.</summary>
    public WrapMode WrapMode { get; init; }

    /// <summary>One for each moved GameObject.</summary>
    [Field(Required = true)]
    public IReadOnlyList<AnimationTrack> Tracks { get; init; } = Array.Empty<AnimationTrack>();

    private protected override string Describe() => $"animation \"{Name}\" of {Invariant.Counted(Tracks.Count, "track")}, {Invariant.Counted(Times.Count, "key")}, {WrapMode}";
}
