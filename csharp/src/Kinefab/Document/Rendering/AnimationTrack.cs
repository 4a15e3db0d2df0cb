using System;
using System.Collections.Generic;
using Kinefab.Json;
using Kinefab.Numerics;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Local transforms of one GameObject at the clip's times.</summary>
public sealed record AnimationTrack : DocumentObject
{
    internal static readonly FieldNames Fields = new(["gameObject"], "localPosition", "localRotation", "extras");

    /// <summary>With nothing stated.</summary>
    public AnimationTrack()
    {
    }

    internal AnimationTrack(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "gameObject":
                    GameObject = json.Int();
                    break;
                case "localPosition":
                    LocalPosition = json.List(static (ref JsonCursor at) => at.Vector3());
                    break;
                case "localRotation":
                    LocalRotation = json.List(static (ref JsonCursor at) => at.Quaternion());
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Index of the GameObject.</summary>
    public int GameObject { get; init; }

    /// <summary>One for each time, metres; empty: it does not move.</summary>
    public IReadOnlyList<Vector3d> LocalPosition { get; init; } = Array.Empty<Vector3d>();

    /// <summary>One for each time; empty: it does not turn.</summary>
    public IReadOnlyList<Quaterniond> LocalRotation { get; init; } = Array.Empty<Quaterniond>();
}
