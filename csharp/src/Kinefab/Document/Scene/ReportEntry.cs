using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Document;

/// <summary>What became of a feature of the source.</summary>
[Words(Letters.Camel)]
public enum Outcome
{
    /// <summary>It is in the scene as it was.</summary>
    Kept,

    /// <summary>It is in the scene as near as Unity allows.</summary>
    Approximated,

    /// <summary>It is not in the scene.</summary>
    Dropped,
}

/// <summary>One line of the exporter's loss report.</summary>
public sealed partial record ReportEntry : DocumentObject
{
    /// <summary>Kind and id in the source.</summary>
    [Field(Required = true)]
    public string Feature { get; init; } = "";

    /// <summary>What became of it.</summary>
    [Field(Required = true)]
    public Outcome Outcome { get; init; }

    /// <summary>How grave that is; null: not stated.</summary>
    public Severity? Severity { get; init; }

    /// <summary>Code of the exporter's diagnostic; null when kept without remark.</summary>
    public string? Code { get; init; }

    /// <summary>In words.</summary>
    public string? Message { get; init; }

    /// <summary>Place in the source.</summary>
    public string? Source { get; init; }

    private protected override string Describe() => $"{Outcome} {Feature}{(Code is null ? "" : $" {Code}")}{(Message is null ? "" : $": {Message}")}";
}

/// <summary>The words of the scene file for <see cref="Severity"/>.</summary>
internal static class SeverityWords
{
    internal static readonly Words<Severity> Table = new(
        ("error", Severity.Error),
        ("warning", Severity.Warning),
        ("info", Severity.Info));
}
