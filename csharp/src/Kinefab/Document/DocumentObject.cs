using System.Diagnostics;
using System;
using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>
/// Anything written as a JSON object in a scene file.  Immutable once made; <c>with</c> gives a copy with some fields changed:
/// <c>settings with { UseLimits = false }</c>.  Two are equal when all their fields are, lists being the same lists.
/// </summary>
[DebuggerDisplay("{ToString(),nq}")]
public abstract record DocumentObject
{
    private protected DocumentObject()
    {
    }

    /// <summary>The object's <c>extras</c> as raw JSON text, kept as it stood and never interpreted; null when there are none.</summary>
    public string? ExtrasJson { get; init; }

    /// <summary>Writes it as a JSON object, less the fields at their defaults.</summary>
    internal abstract void Write(JsonWriter json);

    /// <summary>Looks for nulls where none belong.</summary>
    internal abstract void Search(NullSearch nulls);

    /// <summary>What it is, in one line with units.</summary>
    public sealed override string ToString() => Describe();

    private protected virtual string Describe() => GetType().Name;

    /// <summary>A line with numbers as JSON writes them.</summary>
    private protected static string Line(FormattableString text) => FormattableString.Invariant(text);
}
