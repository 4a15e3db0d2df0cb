namespace Kinefab.Document;

/// <summary>One of three axes.</summary>
[Words]
public enum Axis
{
    /// <summary>First.</summary>
    X,

    /// <summary>Second.</summary>
    Y,

    /// <summary>Third.</summary>
    Z,
}
