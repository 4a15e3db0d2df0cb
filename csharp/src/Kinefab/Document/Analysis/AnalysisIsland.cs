using System;
using System.Collections.Generic;
using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Bodies that hang together by joints, the ground left out.</summary>
public sealed record AnalysisIsland : DocumentObject
{
    internal static readonly FieldNames Fields = new(["gameObjects", "mobility"], "redundant", "loops", "extras");

    /// <summary>With nothing stated.</summary>
    public AnalysisIsland()
    {
    }

    internal AnalysisIsland(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "gameObjects":
                    GameObjects = json.List(static (ref JsonCursor at) => at.Int());
                    break;
                case "mobility":
                    Mobility = json.Int();
                    break;
                case "redundant":
                    Redundant = json.Int();
                    break;
                case "loops":
                    Loops = json.Int();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Indices of GameObjects.</summary>
    public IReadOnlyList<int> GameObjects { get; init; } = Array.Empty<int>();

    /// <summary>Freedoms of finite motion.</summary>
    public int Mobility { get; init; }

    /// <summary>Rows that remove nothing; null: not stated.</summary>
    public int? Redundant { get; init; }

    /// <summary>Closed loops; null: not stated.</summary>
    public int? Loops { get; init; }
}
