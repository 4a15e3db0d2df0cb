using System;

namespace Kinefab.Document;

/// <summary>The letters of an enum's words in the file.</summary>
internal enum Letters
{
    /// <summary>As the members are written.</summary>
    Same,

    /// <summary>angularX.</summary>
    Camel,

    /// <summary>pin_slot.</summary>
    Snake,
}

/// <summary>An enum whose members' names are its words in the file: the generator of nouns makes its table, NameWords.</summary>
[AttributeUsage(AttributeTargets.Enum)]
internal sealed class WordsAttribute : Attribute
{
    internal WordsAttribute(Letters letters = Letters.Same) => Letters = letters;

    internal Letters Letters { get; }
}
