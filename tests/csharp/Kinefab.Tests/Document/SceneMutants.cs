using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;
using Kinefab.Document;
using Kinefab.Tests.Conformance;

namespace Kinefab.Tests.Document;

/// <summary>Texts that are nearly scenes.</summary>
internal static class SceneMutants
{
    private static readonly string[] Tokens =
    [
        "0", "-1", "1", "2", "7", "0.5", "-0", "1e-400", "1e39", "1e400", "2147483648", "-2147483649", "9007199254740993", "null", "true", "false",
        "\"\"", "\"x\"", "\"site\"", "\"angle\"", "[]", "{}", "[0]", "[0, 0, 0]", "[0, 0, 0, 1]", "[1, 1, 1, 1]",
    ];

    private static readonly Regex Token = new("\"(?:[^\"\\\\]|\\\\.)*\"(?!\\s*:)|-?\\d+(?:\\.\\d+)?(?:[eE][-+]?\\d+)?|true|false", RegexOptions.Compiled);

    /// <summary>What they are made of.</summary>
    public static readonly (string Text, SceneDocument Document)[] Scenes = ConformanceCases.All
        .Where(entry => entry.Kind == "scene" && entry.Path.StartsWith("valid/", StringComparison.Ordinal) && !entry.Path.StartsWith("valid/container/", StringComparison.Ordinal))
        .Select(entry => (File.ReadAllText(entry.FullPath), SceneFile.Load(entry.FullPath).Document!))
        .ToArray();

    /// <summary>Those that the scenes name.</summary>
    public static readonly Dictionary<string, byte[]> Buffers = ConformanceCases.All
        .Where(entry => entry.Kind == "scene").Select(entry => Path.GetDirectoryName(entry.FullPath)!).Distinct()
        .SelectMany(folder => Directory.GetFiles(folder, "*.bin")).GroupBy(file => Path.GetFileName(file))
        .ToDictionary(files => files.Key, files => File.ReadAllBytes(files.First()));

    /// <summary>How many <c>KINEFAB_MUTANTS</c> asks for.</summary>
    public static int Count(int otherwise) =>
        int.TryParse(Environment.GetEnvironmentVariable("KINEFAB_MUTANTS"), NumberStyles.None, CultureInfo.InvariantCulture, out int count) ? count : otherwise;

    /// <summary>A scene with one to three faults.</summary>
    public static string Text(Random random)
    {
        string text = Scenes[random.Next(Scenes.Length)].Text;
        switch (random.Next(4))
        {
            case 0:
                char[] letters = text.ToCharArray();
                for (int fault = random.Next(1, 4); fault > 0; fault--)
                    letters[random.Next(letters.Length)] = "{}[]\",:\\0123456789-+eE.tfn \n\0u\u00e9"[random.Next(31)];
                return new string(letters);
            case 1:
                List<string> lines = [.. text.Split('\n')];
                int line = random.Next(lines.Count);
                if (random.Next(2) == 0)
                    lines.RemoveAt(line);
                else
                    lines.Insert(random.Next(lines.Count), lines[line]);
                return string.Join('\n', lines);
            default:
                return Replaced(text, random);
        }
    }

    /// <summary>One to three values, by ones of this scene, of another or by such as are likely to be wrong.</summary>
    public static string Replaced(string text, Random random)
    {
        for (int fault = random.Next(1, 4); fault > 0; fault--)
        {
            MatchCollection found = Token.Matches(text);
            if (found.Count == 0)
                return text;
            Match at = found[random.Next(found.Count)];
            MatchCollection others = random.Next(2) == 0 ? found : Token.Matches(Scenes[random.Next(Scenes.Length)].Text);
            string with = random.Next(2) == 0 || others.Count == 0 ? Tokens[random.Next(Tokens.Length)] : others[random.Next(others.Count)].Value;
            text = string.Concat(text.AsSpan(0, at.Index), with, text.AsSpan(at.Index + at.Length));
        }

        return text;
    }
}
