using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>
/// A scene file as it stands: Unity's terms, left-handed, +Y up, +Z forward, metres, kilograms, seconds.
/// Nothing has been checked but its shape; <c>SceneValidator</c> checks the rest.
/// </summary>
public sealed partial record SceneDocument : DocumentObject
{
    private GameObject[] gameObjects = Array.Empty<GameObject>();
    private SourceText? text;

    /// <summary>What kind of file it is.</summary>
    [Field(Required = true, Reader = "FormatVersion.ReadFormat")]
    internal string Format { get; init; } = FormatVersion.Format;

    /// <summary>Version of the format that the file states, "1.x".</summary>
    [Field(Required = true, Reader = "FormatVersion.ReadVersion")]
    public string Version { get; init; } = "1.0";

    /// <summary>The kind of file that it was read from, or is to be saved as.</summary>
    [Field(InFile = false)]
    public SceneContainer Container { get; init; }

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

    /// <summary>Image files of textures.</summary>
    [Since(1)]
    public IReadOnlyList<Image> Images { get; init; } = Array.Empty<Image>();

    /// <summary>Materials.</summary>
    public IReadOnlyList<Material> Materials { get; init; } = Array.Empty<Material>();

    /// <summary>Of colliders.</summary>
    [Since(1)]
    public IReadOnlyList<PhysicsMaterial> PhysicsMaterials { get; init; } = Array.Empty<PhysicsMaterial>();

    /// <summary>Flat and ordered: a parent stands before its children.</summary>
    [Field(Required = true, Into = nameof(gameObjects))]
    public IReadOnlyList<GameObject> GameObjects
    {
        get => gameObjects;
        init => gameObjects = value.ToArray();
    }

    /// <summary>The same, without the price of an interface.</summary>
    internal ReadOnlySpan<GameObject> GameObjectSpan => gameObjects;

    /// <summary>Relations between joint coordinates.</summary>
    public IReadOnlyList<Coupling> Couplings { get; init; } = Array.Empty<Coupling>();

    /// <summary>Pairs of bodies that pass through each other by a rule of the source, beside those that a joint of its own keeps from colliding.</summary>
    [Since(1)]
    public IReadOnlyList<IgnoredCollision> IgnoredCollisions { get; init; } = Array.Empty<IgnoredCollision>();

    /// <summary>Animations.</summary>
    public IReadOnlyList<AnimationClip> Animations { get; init; } = Array.Empty<AnimationClip>();

    /// <summary>The source's own constraints.</summary>
    public IReadOnlyList<Constraint> Constraints { get; init; } = Array.Empty<Constraint>();

    /// <summary>Mobility as the exporter found it; null: not analysed.</summary>
    public Analysis? Analysis { get; init; }

    /// <summary>The exporter's loss report.</summary>
    public IReadOnlyList<ReportEntry> Report { get; init; } = Array.Empty<ReportEntry>();

    /// <summary>The bytes of an image's file, without a copy; empty where the buffer is not loaded or does not hold them.</summary>
    /// <param name="image">One of <see cref="Images"/>.</param>
    /// <returns>A part of the buffer's memory.</returns>
    public ReadOnlyMemory<byte> BytesOf(Image image)
    {
        if (image is null)
            throw new ArgumentNullException(nameof(image));
        if ((uint)image.Data.Buffer >= (uint)Buffers.Count || Buffers[image.Data.Buffer].Data is not { } bytes)
            return default;
        long offset = image.Data.Offset;
        bool isInside = offset >= 0 && offset <= bytes.Length && image.ByteLength >= 0 && image.ByteLength <= bytes.Length - offset;
        return isInside ? bytes.Slice((int)offset, (int)image.ByteLength) : default;
    }

    /// <summary>The UTF-8 text that this very scene was read from, for the places of later findings; empty when there is none, as for a changed copy.</summary>
    internal ReadOnlyMemory<byte> Text
    {
        get => text is not null && ReferenceEquals(text.Of, this) ? text.Bytes : default;
        set => text = new SourceText(this, value);
    }

    /// <summary>Tells of each null where none belongs its pointer and what does; in a scene as it was read there is none.</summary>
    internal void FindNulls(Action<string, string> report)
    {
        if (Text.IsEmpty)
            Search(new NullSearch(report));
    }

    private protected override string Describe() =>
        $"scene of {Invariant.Counted(gameObjects.Length, "object")}, {Invariant.Counted(Couplings.Count, "coupling")}, {Invariant.Counted(Meshes.Count, "mesh", "meshes")}, {Invariant.Counted(Materials.Count, "material")}";

    // No record: a document that is compared does not compare its text, which knows the document.
    private sealed class SourceText
    {
        internal SourceText(SceneDocument of, ReadOnlyMemory<byte> bytes)
        {
            Of = of;
            Bytes = bytes;
        }

        internal SceneDocument Of { get; }

        internal ReadOnlyMemory<byte> Bytes { get; }
    }
}
