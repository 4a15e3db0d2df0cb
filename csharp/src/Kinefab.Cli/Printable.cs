using System;
using System.Globalization;
using System.Linq;
using System.Text;

namespace Kinefab.Cli;

/// <summary>Text of a scene as it may stand on a terminal.</summary>
internal static class Printable
{
    /// <summary>The text with control and format characters as \uXXXX, so that an id can neither steer the terminal nor forge a line.</summary>
    internal static string Text(string text) => Escape(text, IsSteering);

    /// <summary>The same for text that is made of lines: their ends stay, and the return that renews a line of progress.</summary>
    internal static string Lines(string text) => Escape(text, character => character is not ('\n' or '\r') && IsSteering(character));

    private static string Escape(string text, Func<char, bool> isEscaped)
    {
        if (!text.Any(isEscaped))
            return text;
        var escaped = new StringBuilder(text.Length);
        foreach (char character in text)
            _ = isEscaped(character) ? escaped.Append(CultureInfo.InvariantCulture, $"\\u{(int)character:X4}") : escaped.Append(character);
        return escaped.ToString();
    }

    private static bool IsSteering(char character) =>
        char.GetUnicodeCategory(character) is UnicodeCategory.Control or UnicodeCategory.Format
            or UnicodeCategory.LineSeparator or UnicodeCategory.ParagraphSeparator;
}
