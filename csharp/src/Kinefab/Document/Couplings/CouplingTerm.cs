namespace Kinefab.Document;

/// <summary>What one coordinate adds to the one that a coupling drives: its ratio times where it stands.</summary>
[Since(1)]
public sealed partial record CouplingTerm : DocumentObject
{
    /// <summary>The coordinate that is followed.</summary>
    [Field(Required = true)]
    public JointCoordinate Coordinate { get; init; } = new();

    /// <summary>Unit of the driven coordinate for each unit of this one, degrees and metres.</summary>
    [Field(Required = true)]
    public double Ratio { get; init; }

    private protected override string Describe() => Line($"{Ratio} * {Coordinate}");
}
