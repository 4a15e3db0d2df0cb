using System;

namespace Kinefab.Document;

/// <summary>
/// What a noun's public init property is in the file beyond a field of its name that may be left out at its default.
/// The generator of nouns (<c>csharp/generators</c>) reads it.
/// </summary>
[AttributeUsage(AttributeTargets.Property)]
internal sealed class FieldAttribute : Attribute
{
    /// <summary>False: it is no field of the file.</summary>
    public bool InFile { get; init; } = true;

    /// <summary>A file without it is faulty.</summary>
    public bool Required { get; init; }

    /// <summary>Written at its default too.</summary>
    public bool Always { get; init; }

    /// <summary>Many objects of a file have the same text there: they get one string.</summary>
    public bool Shared { get; init; }

    /// <summary>Fewest items of a list.</summary>
    public int Least { get; init; }

    /// <summary>What is assigned when it is read, where that is not the property.</summary>
    public string? Into { get; init; }

    /// <summary>The method that reads it, where its type's does not do.</summary>
    public string? Reader { get; init; }
}
