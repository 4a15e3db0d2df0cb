using Kinefab.Diagnostics;
using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>What became of a feature of the source.</summary>
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
public sealed record ReportEntry : DocumentObject
{
    internal static readonly FieldNames Fields = new(
        ["feature", "outcome"],
        "severity", "code", "message", "source", "extras");

    /// <summary>With nothing stated.</summary>
    public ReportEntry()
    {
    }

    internal ReportEntry(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "feature":
                    Feature = json.Text();
                    break;
                case "outcome":
                    Outcome = json.Word(OutcomeWords.Table);
                    break;
                case "severity":
                    Severity = json.Word(SeverityWords.Table);
                    break;
                case "code":
                    Code = json.Text();
                    break;
                case "message":
                    Message = json.Text();
                    break;
                case "source":
                    Source = json.Text();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Kind and id in the source.</summary>
    public string Feature { get; init; } = "";

    /// <summary>What became of it.</summary>
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

/// <summary>The words of the scene file for <see cref="Outcome"/>.</summary>
internal static class OutcomeWords
{
    internal static readonly Words<Outcome> Table = new(
        ("kept", Outcome.Kept),
        ("approximated", Outcome.Approximated),
        ("dropped", Outcome.Dropped));
}

/// <summary>The words of the scene file for <see cref="Severity"/>.</summary>
internal static class SeverityWords
{
    internal static readonly Words<Severity> Table = new(
        ("error", Severity.Error),
        ("warning", Severity.Warning),
        ("info", Severity.Info));
}
