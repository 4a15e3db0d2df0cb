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

/// <summary>q_b = ratio * q_a + offset between two joint coordinates, degrees and metres.</summary>
public sealed partial record Coupling : DocumentObject
{
    /// <summary>Name in the source; null when it has none.</summary>
    public string? Id { get; init; }

    /// <summary>What it is in the source; no influence on the relation.</summary>
    [Field(Required = true)]
    public CouplingKind Kind { get; init; }

    /// <summary>The driving coordinate.</summary>
    [Field(Required = true)]
    public JointCoordinate A { get; init; } = new();

    /// <summary>The driven coordinate.</summary>
    [Field(Required = true)]
    public JointCoordinate B { get; init; } = new();

    /// <summary>Unit of b for each unit of a.</summary>
    [Field(Required = true)]
    public double Ratio { get; init; }

    /// <summary>Unit of b.</summary>
    public double Offset { get; init; }

    private protected override string Describe() => Line($"{Kind}{(Id is null ? "" : $" \"{Id}\"")}: {B} = {Ratio} * {A}{(Offset == 0 ? "" : $" + {Offset}")}");
}
