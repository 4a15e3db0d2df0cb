namespace Kinefab.Document;

/// <summary>Worst misfit of the exported pose.</summary>
public sealed partial record ClosureGap : DocumentObject
{
    /// <summary>Metres.</summary>
    [Field(Always = true)]
    public double Position { get; init; }

    /// <summary>Degrees.</summary>
    [Field(Always = true)]
    public double Angle { get; init; }
}
