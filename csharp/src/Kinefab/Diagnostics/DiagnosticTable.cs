using System;
using System.Collections.Generic;
using System.IO;
using System.Text;
using Kinefab.Json;

namespace Kinefab.Diagnostics;

/// <summary>The table of diagnostics that Python and C# share: schemas/diagnostics.json, embedded.</summary>
internal static class DiagnosticTable
{
    private static readonly Lazy<Dictionary<string, Entry>> Table = new(Read);

    internal static IReadOnlyDictionary<string, Entry> Entries => Table.Value;

    /// <summary>
    /// Fills {placeholders} of a template with the given values, in one pass: what a value holds is data, also where it
    /// looks like a placeholder.  {{ and }} stand for braces, as in Python's str.format, which fills the same table.
    /// </summary>
    internal static string Fill(string template, ReadOnlySpan<(string Name, string Value)> values)
    {
        var text = new StringBuilder();
        for (int at = 0; at < template.Length; at++)
        {
            char letter = template[at];
            bool isDoubled = letter is '{' or '}' && at + 1 < template.Length && template[at + 1] == letter;
            int end = letter == '{' && !isDoubled ? template.IndexOf('}', at) : -1;
            if (end > 0 && ValueOf(template.AsSpan(at + 1, end - at - 1), values) is string value)
            {
                text.Append(value);
                at = end;
                continue;
            }

            text.Append(letter);
            if (isDoubled)
                at++;
        }

        return text.ToString();
    }

    private static string? ValueOf(ReadOnlySpan<char> placeholder, ReadOnlySpan<(string Name, string Value)> values)
    {
        foreach ((string name, string value) in values)
        {
            if (placeholder.SequenceEqual(name.AsSpan()))
                return value;
        }

        return null;
    }

    private static Dictionary<string, Entry> Read()
    {
        using Stream stream = typeof(DiagnosticTable).Assembly.GetManifestResourceStream("Kinefab.diagnostics.json")!;
        using var copy = new MemoryStream();
        stream.CopyTo(copy);
        var entries = new Dictionary<string, Entry>(StringComparer.Ordinal);
        foreach ((string code, JsonTree line) in JsonTree.Parse(copy.ToArray())["codes"]!.Fields)
        {
            Severity severity = SeverityNames.Parse(line["severity"]!.AsString())!.Value;
            entries.Add(code, new Entry(line["stage"]!.AsString(), severity, line["message"]!.AsString(), line["remedy"]!.AsString()));
        }

        return entries;
    }

    internal sealed class Entry
    {
        internal Entry(string stage, Severity severity, string message, string remedy)
        {
            Stage = stage;
            Severity = severity;
            Message = message;
            Remedy = remedy;
        }

        internal string Stage { get; }

        internal Severity Severity { get; }

        internal string Message { get; }

        internal string Remedy { get; }
    }
}
