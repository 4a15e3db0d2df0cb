using System;
using System.Collections.Generic;
using Kinefab.Json;

namespace Kinefab.Document;

/// <summary>Kinds of geometric constraints.</summary>
[Words(Letters.Snake)]
public enum ConstraintKind
{
    /// <summary>Points, lines or planes lie in each other.</summary>
    Coincident,

    /// <summary>Axes coincide.</summary>
    Concentric,

    /// <summary>Directions are parallel.</summary>
    Parallel,

    /// <summary>Directions are at right angles.</summary>
    Perpendicular,

    /// <summary>Directions enclose an angle.</summary>
    Angle,

    /// <summary>A distance is kept.</summary>
    Distance,

    /// <summary>Surfaces touch.</summary>
    Tangent,

    /// <summary>Axes coincide and planes meet.</summary>
    Insert,

    /// <summary>Mirror images of each other.</summary>
    Symmetry,

    /// <summary>No relative motion.</summary>
    Lock,

    /// <summary>No relative rotation.</summary>
    LockOrientation,

    /// <summary>One translation.</summary>
    Slider,

    /// <summary>A pin in a slot.</summary>
    PinSlot,

    /// <summary>A universal joint.</summary>
    Universal,

    /// <summary>A screw.</summary>
    Screw,

    /// <summary>A pair of gears.</summary>
    Gear,

    /// <summary>A belt or chain.</summary>
    Belt,

    /// <summary>A rack and pinion.</summary>
    Rack,

    /// <summary>A linear relation.</summary>
    Linear,

    /// <summary>Fixed to the world.</summary>
    Ground,

    /// <summary>Anything else, written through.</summary>
    Other,
}

/// <summary>How two directions stand to each other.</summary>
public enum ConstraintSense
{
    /// <summary>Either way.</summary>
    Either,

    /// <summary>Along each other.</summary>
    Aligned,

    /// <summary>Against each other.</summary>
    Opposed,
}

/// <summary>On which side of the other surface a tangency is.</summary>
public enum ConstraintSide
{
    /// <summary>That of the exported pose.</summary>
    Either,

    /// <summary>Inside.</summary>
    Inside,

    /// <summary>Outside.</summary>
    Outside,
}

/// <summary>A geometric constraint of the source, written through for whoever wants it.</summary>
public sealed partial record Constraint : DocumentObject
{
    /// <summary>Id in the source.</summary>
    [Field(Required = true)]
    public string Id { get; init; } = "";

    /// <summary>Name in the source.</summary>
    public string? Name { get; init; }

    /// <summary>Kind.</summary>
    [Field(Required = true)]
    public ConstraintKind Kind { get; init; }

    /// <summary>The source's own word for the kind.</summary>
    public string? RawKind { get; init; }

    /// <summary>The constrained geometry.</summary>
    [Field(Required = true)]
    public IReadOnlyList<Feature> Features { get; init; } = Array.Empty<Feature>();

    /// <summary>Metres, degrees, or metres a turn for a screw.</summary>
    public double Value { get; init; }

    /// <summary>As <see cref="Value"/>; null: no range.</summary>
    public double? Lower { get; init; }

    /// <summary>As <see cref="Value"/>; null: no range.</summary>
    public double? Upper { get; init; }

    /// <summary>How the directions stand.</summary>
    public ConstraintSense Sense { get; init; }

    /// <summary>Side of a tangency.</summary>
    public ConstraintSide Side { get; init; }

    /// <summary>Whether a concentric pair may not turn.</summary>
    public bool LockRotation { get; init; }

    /// <summary>Present in the source, not acting.</summary>
    public bool Suppressed { get; init; }

    /// <summary>The vendor's meaning where the same words remove different freedoms.</summary>
    public IReadOnlyDictionary<string, string> Reading { get; init; } = new Dictionary<string, string>();

    private protected override string Describe() => Line($"{Kind} \"{Name ?? Id}\" of {Features.Count} features{(Suppressed ? ", suppressed" : "")}");
}

/// <summary>The words of the scene file for <see cref="ConstraintSense"/>.</summary>
internal static class ConstraintSenseWords
{
    internal static readonly Words<ConstraintSense> Table = new(
        ("aligned", ConstraintSense.Aligned),
        ("opposed", ConstraintSense.Opposed),
        ("either", ConstraintSense.Either));
}

/// <summary>The words of the scene file for <see cref="ConstraintSide"/>.</summary>
internal static class ConstraintSideWords
{
    internal static readonly Words<ConstraintSide> Table = new(
        ("inside", ConstraintSide.Inside),
        ("outside", ConstraintSide.Outside),
        ("either", ConstraintSide.Either));
}
