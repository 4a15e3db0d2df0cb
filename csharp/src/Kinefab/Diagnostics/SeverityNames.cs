namespace Kinefab.Diagnostics;

/// <summary>The words that JSON files use for a severity.</summary>
internal static class SeverityNames
{
    internal static string ToJson(this Severity severity) => severity switch
    {
        Severity.Error => "error",
        Severity.Warning => "warning",
        _ => "info",
    };

    internal static Severity? Parse(string word) => word switch
    {
        "error" => Severity.Error,
        "warning" => Severity.Warning,
        "info" => Severity.Info,
        _ => null,
    };
}
