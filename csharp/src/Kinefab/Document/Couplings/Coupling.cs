using System;
using System.Collections.Generic;

namespace Kinefab.Document;

/// <summary>What makes two joint coordinates move together.</summary>
[Words(Letters.Camel)]
public enum CouplingKind
{
    /// <summary>A pair of gears.</summary>
    Gear,

    /// <summary>A belt or chain.</summary>
    Belt,

    /// <summary>A rack and pinion.</summary>
    Rack,

    /// <summary>A screw: both coordinates are of one joint.</summary>
    Screw,

    /// <summary>Any other linear relation.</summary>
    Linear,
}

/// <summary>
/// q_b = ratio_1 q_1 + ratio_2 q_2 + ... + offset between joint coordinates, degrees and metres. One that follows a single
/// coordinate has it as <see cref="A"/> with its <see cref="Ratio"/>; one that follows several has them as <see cref="Terms"/>.
/// </summary>
public sealed partial record Coupling : DocumentObject
{
    /// <summary>Name in the source; null when it has none.</summary>
    public string? Id { get; init; }

    /// <summary>What it is in the source; no influence on the relation.</summary>
    [Field(Required = true)]
    public CouplingKind Kind { get; init; }

    /// <summary>The one driving coordinate; null where there are <see cref="Terms"/>.</summary>
    public JointCoordinate? A { get; init; }

    /// <summary>The driven coordinate.</summary>
    [Field(Required = true)]
    public JointCoordinate B { get; init; } = new();

    /// <summary>Unit of b for each unit of a; null where there are <see cref="Terms"/>.</summary>
    public double? Ratio { get; init; }

    /// <summary>All driving coordinates in the place of <see cref="A"/>; empty where that is there.</summary>
    [Field(Least = 1)]
    [Since(1)]
    public IReadOnlyList<CouplingTerm> Terms { get; init; } = Array.Empty<CouplingTerm>();

    /// <summary>Unit of b.</summary>
    public double Offset { get; init; }

    /// <summary>What b follows, whichever way the file says it; empty where it says neither, which no valid scene does.</summary>
    public IReadOnlyList<CouplingTerm> Followed =>
        Terms.Count > 0 ? Terms : A is JointCoordinate a && Ratio is double ratio ? new[] { new CouplingTerm { Coordinate = a, Ratio = ratio } } : Terms;

    private protected override string Describe() =>
        Line($"{Kind}{(Id is null ? "" : $" \"{Id}\"")}: {B} = {string.Join(" + ", Followed)}{(Offset == 0 ? "" : Line($" + {Offset}"))}");
}
