using Kinefab.Json;

namespace Kinefab.Document;

/// <summary>One of three axes.</summary>
public enum Axis
{
    /// <summary>First.</summary>
    X,

    /// <summary>Second.</summary>
    Y,

    /// <summary>Third.</summary>
    Z,
}

/// <summary>The words of the scene file for <see cref="Axis"/>.</summary>
internal static class AxisWords
{
    internal static readonly Words<Axis> Table = new(("X", Axis.X), ("Y", Axis.Y), ("Z", Axis.Z));
}
