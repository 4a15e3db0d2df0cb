using System.Diagnostics;
using System;

namespace Kinefab.Advice;

/// <summary>One field of a scene file set to a value: all that a tried change is.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class SceneEdit
{
    internal SceneEdit(string pointer, string value)
    {
        Pointer = pointer;
        Value = value;
    }

    /// <summary>JSON pointer (RFC 6901) of the field; objects on the way that the file leaves out are made.</summary>
#pragma warning disable CA1720 // JSON pointer is RFC 6901's term.
    public string Pointer { get; }
#pragma warning restore CA1720

    /// <summary>The new value as JSON text.</summary>
    public string Value { get; }

    /// <summary>/physics/fixedTimestep = 0.01.</summary>
    public override string ToString() => $"{Pointer} = {Value}";
}
