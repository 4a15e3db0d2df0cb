using System;
using System.Collections.Generic;
using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Mobility of the mechanism, as the exporter found it from the source's constraints.</summary>
public sealed record Analysis : DocumentObject
{
    internal static readonly FieldNames Fields = new(
        ["mobility"],
        "firstOrderMobility", "redundant", "idle", "closureGap", "islands", "bodies", "extras");

    /// <summary>With nothing stated.</summary>
    public Analysis()
    {
    }

    internal Analysis(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "mobility":
                    Mobility = json.Int();
                    break;
                case "firstOrderMobility":
                    FirstOrderMobility = json.Int();
                    break;
                case "redundant":
                    Redundant = json.Int();
                    break;
                case "idle":
                    Idle = json.Int();
                    break;
                case "closureGap":
                    ClosureGap = new ClosureGap(ref json);
                    break;
                case "islands":
                    Islands = json.List(static (ref JsonCursor at) => new AnalysisIsland(ref at));
                    break;
                case "bodies":
                    Bodies = json.List(static (ref JsonCursor at) => new BodyFreedom(ref at));
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Freedoms of finite motion.</summary>
    public int Mobility { get; init; }

    /// <summary>Freedoms of the velocities at the exported pose; null: not stated.</summary>
    public int? FirstOrderMobility { get; init; }

    /// <summary>Constraint rows that remove nothing at the exported pose; null: not stated.</summary>
    public int? Redundant { get; init; }

    /// <summary>Freedoms of single bodies that move nothing else; null: not stated.</summary>
    public int? Idle { get; init; }

    /// <summary>Worst misfit of the exported pose; null: not stated.</summary>
    public ClosureGap? ClosureGap { get; init; }

    /// <summary>Bodies that hang together by joints.</summary>
    public IReadOnlyList<AnalysisIsland> Islands { get; init; } = Array.Empty<AnalysisIsland>();

    /// <summary>What each body can still do.</summary>
    public IReadOnlyList<BodyFreedom> Bodies { get; init; } = Array.Empty<BodyFreedom>();

    private protected override string Describe() => $"mobility {Mobility}, {Islands.Count} islands, {Bodies.Count} bodies";
}
