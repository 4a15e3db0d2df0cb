using System.Globalization;
using System.Linq;
using System.Text;

namespace Kinefab.Cli;

/// <summary>Text of a scene as it may stand on a terminal.</summary>
internal static class Printable
{
    /// <summary>The text with control and format characters as \uXXXX, so that an id can neither steer the terminal nor forge a line.</summary>
    internal static string Text(string text)
    {
        if (!text.Any(IsSteering))
            return text;
        var escaped = new StringBuilder(text.Length);
        foreach (char character in text)
            _ = IsSteering(character) ? escaped.Append(CultureInfo.InvariantCulture, $"\\u{(int)character:X4}") : escaped.Append(character);
        return escaped.ToString();
    }

    private static bool IsSteering(char character) =>
        char.GetUnicodeCategory(character) is UnicodeCategory.Control or UnicodeCategory.Format
            or UnicodeCategory.LineSeparator or UnicodeCategory.ParagraphSeparator;
}
