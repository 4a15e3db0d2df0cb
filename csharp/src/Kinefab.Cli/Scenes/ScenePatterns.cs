using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;

namespace Kinefab.Cli;

/// <summary>Patterns of file names, for shells that expand none: * and ? within a name, ** over folders.</summary>
internal static class ScenePatterns
{
    private static readonly char[] Wildcards = ['*', '?'];

    /// <summary>The files in their order, those of a pattern by name, each once; a pattern that nothing matches stays as it is.</summary>
    internal static IReadOnlyList<string> Expand(IEnumerable<string> given) => given.SelectMany(Expand).Distinct(StringComparer.Ordinal).ToList();

    private static IEnumerable<string> Expand(string given)
    {
        if (given.IndexOfAny(Wildcards) < 0 || File.Exists(given))
            return [given];
        string slashed = Path.DirectorySeparatorChar == '\\' ? given.Replace('\\', '/') : given;
        int fixedEnd = slashed.LastIndexOf('/', slashed.IndexOfAny(Wildcards)) + 1;
        string folder = slashed[..fixedEnd];
        string pattern = slashed[fixedEnd..];
        var wanted = new Regex("^" + Regex.Escape(pattern).Replace(@"\*\*/", "(?:.*/)?", StringComparison.Ordinal).Replace(@"\*\*", ".*", StringComparison.Ordinal)
            .Replace(@"\*", "[^/]*", StringComparison.Ordinal).Replace(@"\?", "[^/]", StringComparison.Ordinal) + "$", RegexOptions.CultureInvariant);
        var options = new EnumerationOptions { RecurseSubdirectories = pattern.Contains('/', StringComparison.Ordinal) || pattern.Contains("**", StringComparison.Ordinal), IgnoreInaccessible = true };
        string root = folder.Length == 0 ? "." : folder;
        if (!Directory.Exists(root))
            return [given];
        string[] found = Directory.EnumerateFiles(root, "*", options)
            .Select(file => Path.GetRelativePath(root, file).Replace('\\', '/'))
            .Where(file => wanted.IsMatch(file))
            .Order(StringComparer.Ordinal)
            .Select(file => folder + file)
            .ToArray();
        return found.Length > 0 ? found : [given];
    }
}
