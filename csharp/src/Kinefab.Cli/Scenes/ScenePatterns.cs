using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;

namespace Kinefab.Cli;

/// <summary>Patterns of file names, for shells that expand none: * and ? within a name, ** over folders.</summary>
internal static class ScenePatterns
{
    private const string AnyFolders = "**";

    private static readonly char[] Wildcards = ['*', '?'];
    private static readonly EnumerationOptions Readable = new() { IgnoreInaccessible = true };

    /// <summary>The files in their order, those of a pattern by name, each once; a pattern that nothing matches stays as it is.</summary>
    internal static IReadOnlyList<string> Expand(IEnumerable<string> given) => given.SelectMany(Expand).Distinct(StringComparer.Ordinal).ToList();

    private static IEnumerable<string> Expand(string given)
    {
        if (given.IndexOfAny(Wildcards) < 0 || File.Exists(given))
            return [given];
        string slashed = Path.DirectorySeparatorChar == '\\' ? given.Replace('\\', '/') : given;
        int fixedEnd = slashed.LastIndexOf('/', slashed.IndexOfAny(Wildcards)) + 1;
        string root = slashed[..fixedEnd];
        if (!Directory.Exists(Named(root)))
            return [given];
        string[] found = [.. Below([root], slashed[fixedEnd..].Split('/')).Order(StringComparer.Ordinal)];
        return found.Length > 0 ? found : [given];
    }

    // Folders end in /, or are empty: the current one.
    private static IEnumerable<string> Below(string[] folders, string[] pattern)
    {
        for (int i = 0; i < pattern.Length - 1; i++)
        {
            if (pattern[i].Contains(AnyFolders, StringComparison.Ordinal))
                return Everywhere(folders, string.Join('/', pattern[i..]));
            Regex wanted = Wanted(pattern[i]);
            folders = [.. folders.SelectMany(Folders).Where(folder => wanted.IsMatch(Path.GetFileName(folder[..^1])))];
        }

        if (pattern[^1].Contains(AnyFolders, StringComparison.Ordinal))
            return Everywhere(folders, pattern[^1]);
        Regex last = Wanted(pattern[^1]);
        return folders.SelectMany(Files).Where(file => last.IsMatch(Path.GetFileName(file)));
    }

    // Links lead round in circles, and to one folder by several names: each is looked into once, by a name without a link where it has one.
    private static IEnumerable<string> Everywhere(string[] roots, string pattern)
    {
        Regex wanted = Wanted(pattern);
        var seen = new HashSet<string>(StringComparer.Ordinal);
        var waiting = new Queue<(string Root, string Folder)>(roots.Select(root => (root, root)));
        var links = new Queue<(string Root, string Folder)>();
        while (waiting.TryDequeue(out (string Root, string Folder) at) || links.TryDequeue(out at))
        {
            if (!seen.Add(Real(Path.GetFullPath(Named(at.Folder)))))
                continue;
            foreach (string file in Files(at.Folder).Where(file => wanted.IsMatch(file[at.Root.Length..])))
                yield return file;
            foreach (string folder in Folders(at.Folder))
                (IsLink(folder) ? links : waiting).Enqueue((at.Root, folder));
        }
    }

    private static IEnumerable<string> Files(string folder) => Directory.EnumerateFiles(Named(folder), "*", Readable).Select(file => folder + Path.GetFileName(file));

    private static IEnumerable<string> Folders(string folder) => Directory.EnumerateDirectories(Named(folder), "*", Readable).Select(below => folder + Path.GetFileName(below) + "/");

    private static string Named(string folder) => folder.Length == 0 ? "." : folder;

    private static bool IsLink(string folder) => new DirectoryInfo(folder[..^1]).LinkTarget is not null;

    // The path without any link on its way.
    private static string Real(string full)
    {
        string at = Path.GetPathRoot(full)!;
        foreach (string name in full[at.Length..].Split(Path.DirectorySeparatorChar, StringSplitOptions.RemoveEmptyEntries))
        {
            at = Path.Combine(at, name);
            if (Directory.ResolveLinkTarget(at, returnFinalTarget: true) is { } target)
                at = Real(target.FullName);
        }

        return at;
    }

    private static Regex Wanted(string pattern) =>
        new("^" + Regex.Escape(pattern).Replace(@"\*\*/", "(?:.*/)?", StringComparison.Ordinal).Replace(@"\*\*", ".*", StringComparison.Ordinal)
            .Replace(@"\*", "[^/]*", StringComparison.Ordinal).Replace(@"\?", "[^/]", StringComparison.Ordinal) + "$", RegexOptions.CultureInvariant);
}
