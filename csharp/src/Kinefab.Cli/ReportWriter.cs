using System.Collections.Generic;
using System.IO;
using System.Text.Json;
using Kinefab.Diagnostics;

namespace Kinefab.Cli;

/// <summary>Reports as people and as programs read them.</summary>
internal static class ReportWriter
{
    // Of one code: a robot has one for each effort and each speed of its joints, or for each of its links.
    private const int MostRemarks = 4;
    private const int MostWarnings = 8;

    /// <summary>
    /// One line a finding on stderr, as compilers write them: file:line:column: severity CODE pointer: message remedy. Of remarks and warnings that are
    /// alike the first ones, and how many more there are.
    /// </summary>
    internal static void WriteLines(string file, Report report, TextWriter target)
    {
        var alike = new Dictionary<(string Code, Severity Severity), int>();
        foreach (Diagnostic found in report.Diagnostics)
        {
            (string, Severity) kind = (found.Code, found.Severity);
            if ((alike[kind] = alike.GetValueOrDefault(kind) + 1) <= Most(found.Severity))
                target.WriteLine(Printable.Text(found.Line is null ? $"{file}: {found}" : $"{file}:{found}"));
        }

        foreach (((string code, Severity severity), int count) in alike)
        {
            (string one, string many) = severity == Severity.Info ? ("more remark", "more remarks") : ("more warning", "more warnings");
            if (count > Most(severity))
                target.WriteLine(Printable.Text($"{file}: {severity.ToJson()} {code}: {Counted.Of(count - Most(severity), one, many)} of this kind; --json lists all."));
        }
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

    private static int Most(Severity severity) => severity switch
    {
        Severity.Info => MostRemarks,
        Severity.Warning => MostWarnings,
        _ => int.MaxValue,
    };

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
