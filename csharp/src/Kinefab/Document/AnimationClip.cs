using System;
using System.Collections.Generic;

namespace Kinefab.Document;

/// <summary>What a clip does at its end.</summary>
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
public sealed class AnimationClip : DocumentObject
{
    /// <summary>Its name.</summary>
    public string Name { get; init; } = "";

    /// <summary>Seconds, rising.</summary>
    public IReadOnlyList<double> Times { get; init; } = Array.Empty<double>();

    /// <summary>What it does at its end.</summary>
    public WrapMode WrapMode { get; init; }

    /// <summary>One for each moved GameObject.</summary>
    public IReadOnlyList<AnimationTrack> Tracks { get; init; } = Array.Empty<AnimationTrack>();
}
