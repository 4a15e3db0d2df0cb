using System;
using System.Collections.Generic;

namespace Kinefab.Document;

/// <summary>
/// A scene file as it stands: Unity's terms, left-handed, +Y up, +Z forward, metres, kilograms, seconds.
/// Nothing has been checked but its shape; <c>SceneValidator</c> checks the rest.
/// </summary>
public sealed class SceneDocument : DocumentObject
{
    /// <summary>Version of the format that the file states, "1.x".</summary>
    public string Version { get; init; } = "1.0";

    /// <summary>The program that wrote the file; null: not stated.</summary>
    public Generator? Generator { get; init; }

    /// <summary>Where the scene came from; null: not stated.</summary>
    public SceneSource? Source { get; init; }

    /// <summary>Project settings.</summary>
    public Physics Physics { get; init; } = Physics.Default;

    /// <summary>Binary data.</summary>
    public IReadOnlyList<SceneBuffer> Buffers { get; init; } = Array.Empty<SceneBuffer>();

    /// <summary>Meshes.</summary>
    public IReadOnlyList<Mesh> Meshes { get; init; } = Array.Empty<Mesh>();

    /// <summary>Materials.</summary>
    public IReadOnlyList<Material> Materials { get; init; } = Array.Empty<Material>();

    /// <summary>Flat and ordered: a parent stands before its children.</summary>
    public IReadOnlyList<GameObject> GameObjects { get; init; } = Array.Empty<GameObject>();

    /// <summary>Relations between joint coordinates.</summary>
    public IReadOnlyList<Coupling> Couplings { get; init; } = Array.Empty<Coupling>();

    /// <summary>Animations.</summary>
    public IReadOnlyList<AnimationClip> Animations { get; init; } = Array.Empty<AnimationClip>();

    /// <summary>The source's own constraints.</summary>
    public IReadOnlyList<Constraint> Constraints { get; init; } = Array.Empty<Constraint>();

    /// <summary>Mobility as the exporter found it; null: not analysed.</summary>
    public Analysis? Analysis { get; init; }

    /// <summary>The exporter's loss report.</summary>
    public IReadOnlyList<ReportEntry> Report { get; init; } = Array.Empty<ReportEntry>();
}
