using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;

namespace Kinefab.Tests.UnityPackage;

/// <summary>A file of Unity's YAML: its documents by fileID, each a map of fields, "m_Spring.damper", "m_Component.0.component.fileID".</summary>
internal sealed class PrefabFile
{
    private PrefabFile(Dictionary<string, Record> documents) => Documents = documents;

    public Dictionary<string, Record> Documents { get; }

    public static PrefabFile Read(string path)
    {
        var documents = new Dictionary<string, Record>();
        string id = "";
        List<string> lines = [];
        foreach (string line in File.ReadLines(path).Append("--- !u!0 &0"))
        {
            if (line.StartsWith("--- ", StringComparison.Ordinal))
            {
                if (id.Length > 0)
                    documents.Add(id, new Record(lines[0].TrimEnd(':'), Flat(lines.Skip(1))));
                id = line[(line.IndexOf('&') + 1)..];
                lines = [];
            }
            else if (!line.StartsWith('%'))
            {
                lines.Add(line);
            }
        }

        return new PrefabFile(documents);
    }

    /// <summary>Assets of a folder by guid.</summary>
    public static Dictionary<string, string> Assets(string folder) => Directory.GetFiles(folder, "*.meta", SearchOption.AllDirectories)
        .ToDictionary(meta => File.ReadLines(meta).First(l => l.StartsWith("guid: ", StringComparison.Ordinal))[6..], meta => meta[..^5]);

    private static Dictionary<string, string> Flat(IEnumerable<string> lines)
    {
        var found = new Dictionary<string, string>();

        // Of each block that a line may stand in: its indent, its path, and how many items it has.
        var blocks = new List<(int Indent, string Path, int Items)> { (2, "", 0) };
        foreach (string line in lines)
        {
            string text = line.TrimStart(' ');
            int indent = line.Length - text.Length;
            while (blocks[^1].Indent > indent || (blocks[^1].Indent == indent && text.StartsWith("- ", StringComparison.Ordinal) != blocks[^1].Path.EndsWith('#') && blocks.Count > 1 && !text.StartsWith("- ", StringComparison.Ordinal)))
                blocks.RemoveAt(blocks.Count - 1);
            if (text.StartsWith("- ", StringComparison.Ordinal))
            {
                // The list's dashes stand at the indent of its own key.
                (int Indent, string Path, int Items) list = blocks[^1].Path.EndsWith('#') ? blocks[^1] : throw new InvalidDataException(line);
                blocks[^1] = (list.Indent, list.Path, list.Items + 1);
                string item = $"{list.Path[..^1]}{list.Items}";
                text = text[2..];
                if (text[0] == '{' || !text.Contains(": ", StringComparison.Ordinal) && !text.EndsWith(':'))
                {
                    Put(found, item, text);
                    continue;
                }

                indent += 2;
                blocks.Add((indent, item + ".", 0));
            }

            int colon = text.IndexOf(':', StringComparison.Ordinal);
            string path = blocks[^1].Path + text[..colon], value = text[(colon + 1)..].Trim();
            if (value.Length > 0)
            {
                Put(found, path, value);
            }
            else
            {
                found[path] = "";
                blocks.Add((indent, path + ".#", 0));
                blocks.Add((indent + 2, path + ".", 0));
            }
        }

        return found;
    }

    private static void Put(Dictionary<string, string> found, string path, string value)
    {
        if (value.Length < 2 || value[0] != '{')
        {
            found[path] = Unquoted(value);
            return;
        }

        foreach (string pair in value[1..^1].Split(", ", StringSplitOptions.RemoveEmptyEntries))
        {
            string[] parts = pair.Split(": ");
            found[$"{path}.{parts[0]}"] = parts[1];
        }
    }

    private static string Unquoted(string text)
    {
        if (text.Length > 1 && text[0] == '\'')
            return text[1..^1].Replace("''", "'", StringComparison.Ordinal);
        if (text.Length < 2 || text[0] != '"')
            return text;
        var plain = new StringBuilder();
        for (int i = 1; i < text.Length - 1; i++)
        {
            if (text[i] != '\\')
            {
                plain.Append(text[i]);
            }
            else if (text[++i] is 'u' or 'U' or 'x')
            {
                int digits = text[i] == 'u' ? 4 : text[i] == 'U' ? 8 : 2;
                int code = int.Parse(text.AsSpan(i + 1, digits), NumberStyles.HexNumber, CultureInfo.InvariantCulture);
                plain.Append(digits == 8 ? char.ConvertFromUtf32(code) : ((char)code).ToString());
                i += digits;
            }
            else
            {
                plain.Append(text[i] == 'n' ? '\n' : text[i] == 't' ? '\t' : text[i]);
            }
        }

        return plain.ToString();
    }

    public sealed record Record(string Class, Dictionary<string, string> Fields)
    {
        public string this[string field] => Fields[field];

        public IEnumerable<string> List(string field)
        {
            for (int i = 0; Fields.TryGetValue($"{field}.{i}.fileID", out string? id) || Fields.TryGetValue($"{field}.{i}.component.fileID", out id); i++)
                yield return id;
        }
    }
}
