using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>Axis-aligned box.</summary>
public sealed partial record Bounds : DocumentObject
{
    /// <summary>Metres.</summary>
    [Field(Required = true)]
    public Vector3d Center { get; init; }

    /// <summary>Half sizes, metres.</summary>
    [Field(Required = true)]
    public Vector3d Extents { get; init; }
}
