using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Text;
using Kinefab.Json;

namespace Kinefab.Reading;

/// <summary>Walks a text once to tell JSON pointers from byte offsets and the other way round.</summary>
internal static class PointerFinder
{
    /// <summary>The pointer of the innermost value or field at each of the rising offsets; broken JSON gives the path up to there.</summary>
    internal static string[] PointersAt(ReadOnlySpan<byte> text, long[] offsets)
    {
        var pointers = new string[offsets.Length];
        var path = new List<(string? Name, int Index)>();
        int next = 0;
        var reader = new Utf8Tokenizer(text, Utf8Tokenizer.MostDepth);
        try
        {
            while (next < offsets.Length && reader.Read())
            {
                bool closes = reader.Token is JsonToken.EndObject or JsonToken.EndArray;
                if (closes)
                    path.RemoveAt(path.Count - 1);
                else if (reader.Token == JsonToken.PropertyName)
                    path[^1] = (Name(ref reader), 0);
                else if (path.Count > 0 && path[^1].Name is null)
                    path[^1] = (null, path[^1].Index + 1);

                for (; next < offsets.Length && offsets[next] < reader.Consumed; next++)
                    pointers[next] = Text(path);

                if (reader.Token == JsonToken.StartObject)
                    path.Add(("", -1));
                else if (reader.Token == JsonToken.StartArray)
                    path.Add((null, -1));
            }
        }
        catch (JsonSyntaxException)
        {
            // The fault itself is among the findings; its place is where the walk stopped.
        }

        for (; next < offsets.Length; next++)
            pointers[next] = Text(path);
        return pointers;
    }

    /// <summary>The offset of the value at each pointer, or of the innermost part of it that is in the text.</summary>
    internal static long[] OffsetsOf(ReadOnlySpan<byte> text, IReadOnlyList<string> pointers)
    {
        var root = new Node();
        Node[] nodes = pointers.Select(pointer => root.Add(pointer)).ToArray();
        var reader = new Utf8Tokenizer(text, Utf8Tokenizer.MostDepth);
        if (reader.Read())
            Walk(ref reader, root);
        return nodes.Select(node => node.NearestOffset).ToArray();
    }

    /// <summary>The pointer's escape for a field name (RFC 6901).</summary>
    internal static string Escape(string name) => name.Replace("~", "~0", StringComparison.Ordinal).Replace("/", "~1", StringComparison.Ordinal);

    private static void Walk(ref Utf8Tokenizer reader, Node node)
    {
        node.Offset = reader.TokenStart;
        bool isObject = reader.Token == JsonToken.StartObject;
        if (node.Children is null || (!isObject && reader.Token != JsonToken.StartArray))
        {
            reader.Skip();
            return;
        }

        for (int index = 0; reader.Read() && reader.Token is not (JsonToken.EndObject or JsonToken.EndArray); index++)
        {
            string name = isObject ? Escape(Name(ref reader)) : index.ToString(CultureInfo.InvariantCulture);
            if (isObject)
                reader.Read();
            if (node.Children.TryGetValue(name, out Node? child) && child.Offset < 0)
                Walk(ref reader, child);
            else
                reader.Skip();
        }
    }

    private static string Name(ref Utf8Tokenizer reader) => reader.TryGetString(out string name) ? name : Encoding.UTF8.GetString(reader.Value);

    private static string Text(List<(string? Name, int Index)> path)
    {
        var text = new StringBuilder();
        foreach ((string? name, int index) in path)
        {
            // An object or array whose first part is still to come is its own place.
            if (index < 0)
                break;
            text.Append('/');
            if (name is null)
                text.Append(index.ToString(CultureInfo.InvariantCulture));
            else
                text.Append(Escape(name));
        }

        return text.ToString();
    }

    /// <summary>A wanted pointer or a part of one.</summary>
    private sealed class Node
    {
        private readonly Node? parent;

        internal Node(Node? parent = null) => this.parent = parent;

        internal Dictionary<string, Node>? Children { get; private set; }

        internal long Offset { get; set; } = -1;

        internal long NearestOffset
        {
            get
            {
                Node at = this;
                while (at.Offset < 0 && at.parent is not null)
                    at = at.parent;
                return Math.Max(0, at.Offset);
            }
        }

        internal Node Add(string pointer)
        {
            Node at = this;
            foreach (string part in pointer.Split('/').Skip(1))
            {
                at.Children ??= new Dictionary<string, Node>(StringComparer.Ordinal);
                if (!at.Children.TryGetValue(part, out Node? child))
                    at.Children.Add(part, child = new Node(at));
                at = child;
            }

            return at;
        }
    }
}
