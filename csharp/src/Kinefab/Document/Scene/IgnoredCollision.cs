namespace Kinefab.Document;

/// <summary>
/// Two bodies that pass through each other by a rule of the source. In Unity a joint of six Free motions between them sees to it;
/// Kinefab's own solvers know no contacts.
/// </summary>
[Since(1)]
public sealed partial record IgnoredCollision : DocumentObject
{
    /// <summary>Index of the GameObject of one of them.</summary>
    [Field(Required = true)]
    public int A { get; init; }

    /// <summary>Index of the GameObject of the other.</summary>
    [Field(Required = true)]
    public int B { get; init; }

    /// <summary>The source's rule in its own words; null when it is not told.</summary>
    public string? Reason { get; init; }

    private protected override string Describe() => Line($"objects {A} and {B} pass through each other{(Reason is null ? "" : $": {Reason}")}");
}
