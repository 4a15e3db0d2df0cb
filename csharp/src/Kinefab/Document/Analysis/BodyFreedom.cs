using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>What one body can still do against the ground.</summary>
public sealed partial record BodyFreedom : DocumentObject
{
    /// <summary>Index of the GameObject.</summary>
    [Field(Required = true)]
    public int GameObject { get; init; }

    /// <summary>Number of translations, 0 to 3.</summary>
    [Field(Required = true)]
    public int Translations { get; init; }

    /// <summary>Number of rotations, 0 to 3.</summary>
    [Field(Required = true)]
    public int Rotations { get; init; }

    /// <summary>Of the translations: world, unit.</summary>
    [Field(Always = true)]
    public IReadOnlyList<Vector3d> Directions { get; init; } = Array.Empty<Vector3d>();

    /// <summary>Of the rotations: world, unit.</summary>
    [Field(Always = true)]
    public IReadOnlyList<Vector3d> Axes { get; init; } = Array.Empty<Vector3d>();
}
