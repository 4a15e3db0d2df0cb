using System;
using System.Collections.Generic;
using System.Text;
using Kinefab.Json;

namespace Kinefab.Reading;

/// <summary>
/// Looks through a document for nulls where none belong: in one that was made in code there may be some, whatever its types say, in one that was read there are none.
/// Each noun says by itself (<c>csharp/generators</c>) what there is to look through.
/// </summary>
internal sealed class NullSearch
{
    private readonly Action<string, string> report;

    // From the document inwards: fields, and indices of items.
    private readonly List<object> path = new();

    /// <summary>A search from the document on.</summary>
    /// <param name="report">Told of each null its pointer and what belongs there.</param>
    internal NullSearch(Action<string, string> report) => this.report = report;

    internal void Text(string name, string? value)
    {
        if (value is null)
            Report(name, "a string");
    }

    internal void Object<T>(string name, T? value, bool mayMiss, Action<T, NullSearch> search)
        where T : class
    {
        if (value is not null)
            Into(name, value, search);
        else if (!mayMiss)
            Report(name, "an object");
    }

    internal void Array<T>(string name, IReadOnlyList<T>? items)
    {
        if (items is null)
            Report(name, "an array");
    }

    internal void Texts(string name, IReadOnlyList<string?>? items)
    {
        Array(name, items);
        path.Add(name);
        for (int i = 0; i < items?.Count; i++)
        {
            if (items[i] is null)
                Report(i, "a string");
        }

        path.RemoveAt(path.Count - 1);
    }

    internal void Objects<T>(string name, IReadOnlyList<T?>? items, Action<T, NullSearch> search)
        where T : class
    {
        Array(name, items);
        path.Add(name);
        for (int i = 0; i < items?.Count; i++)
        {
            if (items[i] is T item)
                Into(i, item, search);
            else
                Report(i, "an object");
        }

        path.RemoveAt(path.Count - 1);
    }

    internal void Map(string name, IReadOnlyDictionary<string, string>? entries)
    {
        if (entries is null)
        {
            Report(name, "an object");
            return;
        }

        path.Add(name);
        foreach (KeyValuePair<string, string> entry in entries)
            Text(entry.Key, entry.Value);
        path.RemoveAt(path.Count - 1);
    }

    private void Into<T>(object step, T value, Action<T, NullSearch> search)
    {
        path.Add(step);
        search(value, this);
        path.RemoveAt(path.Count - 1);
    }

    private void Report(object last, string expected)
    {
        var pointer = new StringBuilder();
        path.Add(last);
        foreach (object step in path)
            pointer.Append('/').Append(step is int index ? Invariant.Text(index) : PointerFinder.Escape((string)step));
        path.RemoveAt(path.Count - 1);
        report(pointer.ToString(), expected);
    }
}
