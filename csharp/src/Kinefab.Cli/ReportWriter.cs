using System.IO;
using System.Text.Json;
using Kinefab.Diagnostics;

namespace Kinefab.Cli;

/// <summary>Reports as people and as programs read them.</summary>
internal static class ReportWriter
{
    /// <summary>One line a finding on stderr, as compilers write them: file:line:column: severity CODE pointer: message remedy.</summary>
    internal static void WriteLines(string file, Report report, TextWriter target)
    {
        foreach (Diagnostic found in report.Diagnostics)
            target.WriteLine(Printable.Text(found.Line is null ? $"{file}: {found}" : $"{file}:{found}"));
    }

    /// <summary>The fields of schemas/report.schema.json into an open JSON object.</summary>
    internal static void WriteFields(Utf8JsonWriter json, string file, Report report)
    {
        json.WriteString("file", file);
        json.WriteBoolean("valid", !report.HasErrors);
        json.WriteNumber("errors", report.Count(Severity.Error));
        json.WriteNumber("warnings", report.Count(Severity.Warning));
        json.WriteStartArray("diagnostics");
        foreach (Diagnostic found in report.Diagnostics)
            Write(json, found);
        json.WriteEndArray();
    }

    private static void Write(Utf8JsonWriter json, Diagnostic found)
    {
        json.WriteStartObject();
        json.WriteString("code", found.Code);
        json.WriteString("severity", found.Severity.ToJson());
        json.WriteString("pointer", found.Pointer);
        if (found.Line is int line && found.Column is int column)
        {
            json.WriteNumber("line", line);
            json.WriteNumber("column", column);
        }

        json.WriteString("message", found.Message);
        json.WriteString("remedy", found.Remedy);
        json.WriteEndObject();
    }
}
