using System.IO;
using System.Runtime.CompilerServices;

namespace Kinefab.Bench;

/// <summary>The file RESULTS.md beside this one: one section for each benchmark, written by the benchmarks themselves.</summary>
internal static class Results
{
    private const string Head =
        "# Benchmark results\n\nWritten by `dotnet run -c Release --project csharp/bench -- all --write`; not by hand. Times\n"
        + "are to be compared within a table only.\n";

    /// <summary>Puts a table in the place of the section's last one.</summary>
    internal static void Write(string section, string table)
    {
        string path = Path.Combine(Path.GetDirectoryName(ThisFile())!, "RESULTS.md");
        string text = File.Exists(path) ? File.ReadAllText(path) : Head;
        string heading = $"\n## {section}\n";
        int start = text.IndexOf(heading, System.StringComparison.Ordinal);
        int end = start < 0 ? -1 : text.IndexOf("\n## ", start + heading.Length, System.StringComparison.Ordinal);
        string before = start < 0 ? text : text[..start];
        string after = end < 0 ? "" : text[end..];
        File.WriteAllText(path, $"{before}{heading}\n{table}{after}");
    }

    private static string ThisFile([CallerFilePath] string path = "") => path;
}
