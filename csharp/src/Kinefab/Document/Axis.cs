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
