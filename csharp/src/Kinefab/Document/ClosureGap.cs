namespace Kinefab.Document;

/// <summary>Worst misfit of the exported pose.</summary>
public sealed class ClosureGap : DocumentObject
{
    /// <summary>Metres.</summary>
    public double Position { get; init; }

    /// <summary>Degrees.</summary>
    public double Angle { get; init; }
}
