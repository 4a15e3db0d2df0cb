using System;
using System.Collections.Generic;
using Kinefab.Json;
using Kinefab.Numerics;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>What one body can still do against the ground.</summary>
public sealed record BodyFreedom : DocumentObject
{
    internal static readonly FieldNames Fields = new(
        ["gameObject", "translations", "rotations"],
        "directions", "axes", "extras");

    /// <summary>With nothing stated.</summary>
    public BodyFreedom()
    {
    }

    internal BodyFreedom(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "gameObject":
                    GameObject = json.Int();
                    break;
                case "translations":
                    Translations = json.Int();
                    break;
                case "rotations":
                    Rotations = json.Int();
                    break;
                case "directions":
                    Directions = json.List(static (ref JsonCursor at) => at.Vector3());
                    break;
                case "axes":
                    Axes = json.List(static (ref JsonCursor at) => at.Vector3());
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Index of the GameObject.</summary>
    public int GameObject { get; init; }

    /// <summary>Number of translations, 0 to 3.</summary>
    public int Translations { get; init; }

    /// <summary>Number of rotations, 0 to 3.</summary>
    public int Rotations { get; init; }

    /// <summary>Of the translations: world, unit.</summary>
    public IReadOnlyList<Vector3d> Directions { get; init; } = Array.Empty<Vector3d>();

    /// <summary>Of the rotations: world, unit.</summary>
    public IReadOnlyList<Vector3d> Axes { get; init; } = Array.Empty<Vector3d>();
}
