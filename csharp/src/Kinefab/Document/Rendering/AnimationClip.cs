using System;
using System.Collections.Generic;
using Kinefab.Json;
using Kinefab.Reading;

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
public sealed record AnimationClip : DocumentObject
{
    internal static readonly FieldNames Fields = new(["name", "times", "tracks"], "wrapMode", "extras");

    /// <summary>With nothing stated.</summary>
    public AnimationClip()
    {
    }

    internal AnimationClip(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "name":
                    Name = json.Text();
                    break;
                case "times":
                    Times = json.List(static (ref JsonCursor at) => at.Number(), least: 1);
                    break;
                case "wrapMode":
                    WrapMode = json.Word(WrapModeWords.Table);
                    break;
                case "tracks":
                    Tracks = json.List(static (ref JsonCursor at) => new AnimationTrack(ref at));
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Its name.</summary>
    public string Name { get; init; } = "";

    /// <summary>Seconds, rising.</summary>
    public IReadOnlyList<double> Times { get; init; } = Array.Empty<double>();

    /// <summary>What it does at its end.</summary>
    public WrapMode WrapMode { get; init; }

    /// <summary>One for each moved GameObject.</summary>
    public IReadOnlyList<AnimationTrack> Tracks { get; init; } = Array.Empty<AnimationTrack>();

    private protected override string Describe() => $"animation \"{Name}\" of {Tracks.Count} tracks, {Times.Count} keys, {WrapMode}";
}

/// <summary>The words of the scene file for <see cref="WrapMode"/>.</summary>
internal static class WrapModeWords
{
    internal static readonly Words<WrapMode> Table = new(
        ("Once", WrapMode.Once),
        ("Loop", WrapMode.Loop),
        ("PingPong", WrapMode.PingPong));
}
