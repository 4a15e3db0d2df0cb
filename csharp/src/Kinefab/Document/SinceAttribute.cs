using System;

namespace Kinefab.Document;

/// <summary>The minor version of the format that has a noun or a field first: a file that says it is of that version at least.</summary>
[AttributeUsage(AttributeTargets.Class | AttributeTargets.Property)]
internal sealed class SinceAttribute : Attribute
{
    internal SinceAttribute(int minor) => Minor = minor;

    internal int Minor { get; }
}
