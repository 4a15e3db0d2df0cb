using System;
using System.Collections.Generic;
using System.Linq;

namespace Kinefab.Cli.Commands;

/// <summary>Commands and options that a mistyped one may have meant.</summary>
internal static class NearWords
{
    /// <summary>" Near matches: --strict." behind a sentence that says what is unknown; nothing where none is near.</summary>
    internal static string Among(string word, IEnumerable<string> known)
    {
        // What differs in more than one letter of three is another word.
        int most = Math.Max(1, word.TrimStart('-').Length / 3);
        string[] near = [.. known.Select(other => (Word: other, Changes: Changes(word, other))).Where(one => one.Changes <= most).OrderBy(one => one.Changes).Select(one => one.Word)];
        return near.Length == 0 ? "" : $" Near matches: {string.Join(", ", near)}.";
    }

    // Letters to be put in, taken out or changed until one word is the other; a long one is near to none.
    private static int Changes(string word, string other)
    {
        if (Math.Abs(word.Length - other.Length) > other.Length)
            return int.MaxValue;
        int[] row = [.. Enumerable.Range(0, other.Length + 1)];
        for (int i = 1; i <= word.Length; i++)
        {
            int above = row[0];
            row[0] = i;
            for (int j = 1; j <= other.Length; j++)
            {
                int changed = above + (char.ToLowerInvariant(word[i - 1]) == other[j - 1] ? 0 : 1);
                above = row[j];
                row[j] = Math.Min(changed, Math.Min(above, row[j - 1]) + 1);
            }
        }

        return row[^1];
    }
}
