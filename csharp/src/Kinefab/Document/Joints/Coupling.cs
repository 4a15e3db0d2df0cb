using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>What makes two joint coordinates move together.</summary>
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
public sealed record Coupling : DocumentObject
{
    internal static readonly FieldNames Fields = new(["kind", "a", "b", "ratio"], "id", "offset", "extras");

    /// <summary>With nothing stated.</summary>
    public Coupling()
    {
    }

    internal Coupling(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "id":
                    Id = json.Text();
                    break;
                case "kind":
                    Kind = json.Word(CouplingKindWords.Table);
                    break;
                case "a":
                    A = new JointCoordinate(ref json);
                    break;
                case "b":
                    B = new JointCoordinate(ref json);
                    break;
                case "ratio":
                    Ratio = json.Number();
                    break;
                case "offset":
                    Offset = json.Number();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Name in the source; null when it has none.</summary>
    public string? Id { get; init; }

    /// <summary>What it is in the source; no influence on the relation.</summary>
    public CouplingKind Kind { get; init; }

    /// <summary>The driving coordinate.</summary>
    public JointCoordinate A { get; init; } = new();

    /// <summary>The driven coordinate.</summary>
    public JointCoordinate B { get; init; } = new();

    /// <summary>Unit of b for each unit of a.</summary>
    public double Ratio { get; init; }

    /// <summary>Unit of b.</summary>
    public double Offset { get; init; }

    private protected override string Describe() => Line($"{Kind}{(Id is null ? "" : $" \"{Id}\"")}: {B} = {Ratio} * {A}{(Offset == 0 ? "" : $" + {Offset}")}");
}

/// <summary>The words of the scene file for <see cref="CouplingKind"/>.</summary>
internal static class CouplingKindWords
{
    internal static readonly Words<CouplingKind> Table = new(
        ("gear", CouplingKind.Gear),
        ("belt", CouplingKind.Belt),
        ("rack", CouplingKind.Rack),
        ("screw", CouplingKind.Screw),
        ("linear", CouplingKind.Linear));
}
