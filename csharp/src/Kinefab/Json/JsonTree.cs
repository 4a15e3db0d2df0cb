using System;
using System.Collections.Generic;
using System.Globalization;
using System.Text;

namespace Kinefab.Json;

/// <summary>A JSON value that can be changed: numbers, words and strings as they stand in the text, fields in their order.</summary>
internal sealed class JsonTree
{
    // Of an object or array null; else the value's text.
    private readonly string? _text;
    private readonly bool _isObject;
    private readonly List<(string Name, JsonTree Value)> _items = new();

    private JsonTree(string? text, bool isObject)
    {
        _text = text;
        _isObject = isObject;
    }

    /// <summary>From a text.</summary>
    /// <exception cref="JsonSyntaxException">It is no JSON.</exception>
    public static JsonTree Parse(ReadOnlySpan<byte> text)
    {
        var json = new Utf8Tokenizer(text, Utf8Tokenizer.MostDepth);
        json.Read();
        JsonTree tree = Read(ref json, text);
        json.Read();
        return tree;
    }

    /// <inheritdoc cref="Parse(ReadOnlySpan{byte})"/>
    public static JsonTree Parse(string text) => Parse(Encoding.UTF8.GetBytes(text));

    /// <summary>An array of numbers.</summary>
    public static JsonTree Numbers(params double[] values)
    {
        var array = new JsonTree(null, isObject: false);
        foreach (double value in values)
            array._items.Add(("", new JsonTree(Invariant.Text(value), isObject: false)));
        return array;
    }

    /// <summary>A string.</summary>
    public static JsonTree String(string value)
    {
        var text = new StringBuilder();
        JsonEscapes.AppendQuoted(text, value);
        return new JsonTree(text.ToString(), isObject: false);
    }

    /// <summary>Of an object its fields, of an array its items without names.</summary>
    public IReadOnlyList<(string Name, JsonTree Value)> Fields => _items;

    /// <summary>A string without quotes and escapes; a number or word as it stands.</summary>
    public string AsString()
    {
        byte[] text = Encoding.UTF8.GetBytes(_text ?? "");
        var json = new Utf8Tokenizer(text, Utf8Tokenizer.MostDepth);
        json.Read();
        return json.TryGetString(out string value) ? value : _text!;
    }

    /// <summary>A field by its name; setting one that is not there puts it behind the others.</summary>
    public JsonTree? this[string name]
    {
        get
        {
            int i = _items.FindIndex(item => item.Name == name);
            return i < 0 ? null : _items[i].Value;
        }

        set
        {
            int i = _items.FindIndex(item => item.Name == name);
            if (i >= 0)
                _items[i] = (name, value!);
            else
                _items.Add((name, value!));
        }
    }

    /// <summary>An item by its place.</summary>
    public JsonTree this[int index] => _items[index].Value;

    /// <summary>Takes a field out, if it is there.</summary>
    public void Remove(string name) => _items.RemoveAll(item => item.Name == name);

    /// <summary>Sets the value at a JSON pointer (RFC 6901); objects on the way that are not there are made.</summary>
    public void Set(string pointer, JsonTree value)
    {
        string[] path = Array.ConvertAll(pointer.Split('/'), part => part.Replace("~1", "/", StringComparison.Ordinal).Replace("~0", "~", StringComparison.Ordinal));
        JsonTree at = this;
        for (int i = 1; i < path.Length - 1; i++)
            at = at._isObject ? at[path[i]] ??= new JsonTree(null, isObject: true) : at[Index(path[i])];
        string last = path[path.Length - 1];
        if (at._isObject)
            at[last] = value;
        else
            at._items[Index(last)] = ("", value);
    }

    /// <summary>A copy of its own.</summary>
    public JsonTree Clone()
    {
        var copy = new JsonTree(_text, _isObject);
        foreach ((string name, JsonTree value) in _items)
            copy._items.Add((name, value.Clone()));
        return copy;
    }

    /// <summary>JSON without white space.</summary>
    public override string ToString()
    {
        var text = new StringBuilder();
        Write(text);
        return text.ToString();
    }

    private static JsonTree Read(ref Utf8Tokenizer json, ReadOnlySpan<byte> text)
    {
        if (json.Token is not (JsonToken.StartObject or JsonToken.StartArray))
            return new JsonTree(Encoding.UTF8.GetString(text.Slice(json.TokenStart, json.Consumed - json.TokenStart)), isObject: false);
        var container = new JsonTree(null, json.Token == JsonToken.StartObject);
        while (json.Read() && json.Token is not (JsonToken.EndObject or JsonToken.EndArray))
        {
            string name = "";
            if (container._isObject)
            {
                name = json.TryGetString(out string plain) ? plain : Encoding.UTF8.GetString(json.Value);
                json.Read();
            }

            container._items.Add((name, Read(ref json, text)));
        }

        return container;
    }

    private void Write(StringBuilder text)
    {
        if (_text is not null)
        {
            text.Append(_text);
            return;
        }

        text.Append(_isObject ? '{' : '[');
        for (int i = 0; i < _items.Count; i++)
        {
            if (i > 0)
                text.Append(',');
            if (_isObject)
            {
                JsonEscapes.AppendQuoted(text, _items[i].Name);
                text.Append(':');
            }

            _items[i].Value.Write(text);
        }

        text.Append(_isObject ? '}' : ']');
    }

    private static int Index(string part) => int.Parse(part, CultureInfo.InvariantCulture);
}
