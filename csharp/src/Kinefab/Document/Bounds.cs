using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>Axis-aligned box.</summary>
public sealed class Bounds : DocumentObject
{
    /// <summary>Metres.</summary>
    public Vector3d Center { get; init; }

    /// <summary>Half sizes, metres.</summary>
    public Vector3d Extents { get; init; }
}
